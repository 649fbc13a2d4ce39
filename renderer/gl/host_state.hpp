#pragma once

#include <functional>
#include <vector>

#include "renderer/gl/functions.hpp"

namespace candela::gl {

/// Saves the host's GL state and sets what rendering assumes. The destructor restores all state of OpenGL 4.5
/// that rendering changes, to the last draw buffer, viewport and binding point:
///
/// - framebuffers, program, vertex array, indirect buffers, active texture unit;
/// - textures, samplers, images and indexed uniform and storage buffers, where rendering binds its own;
/// - viewports, depth ranges, clip control; depth, cull, polygon, blend, colour-mask and clear state;
/// - all capabilities that would change the picture, such as the scissor test or clip distances.
///
/// Transform feedback of the host is paused meanwhile. Pixel transfers save their own state where they
/// happen. Not restored, because OpenGL cannot:
///
/// - a program, or the selection of its subroutines: a program that the host has deleted while it was current
///   is gone afterwards, and no program is current; subroutine uniforms of a current program are reset;
/// - results of queries: one of the host's that is active meanwhile also counts what rendering does.
///
/// Conditional rendering must not be active, because OpenGL cannot tell whether it is. State that OpenGL 4.6
/// or extensions add is not looked at; of that, rendering resets the clamp of the polygon offset.
class HostState {
 public:
    /// `gl` must outlive the object.
    explicit HostState(const Functions& gl);
    ~HostState();
    HostState(const HostState&) = delete;
    HostState& operator=(const HostState&) = delete;

 private:
    std::vector<std::function<void()>> restore_;  ///< in the order in which they are called
};

}  // namespace candela::gl
