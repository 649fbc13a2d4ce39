#pragma once

#include <functional>
#include <vector>

#include "renderer/gl/functions.hpp"

namespace candela::gl {

/// Sets what all passes assume, which none of Candela's own changes: no capability that would change the
/// picture is enabled, nothing is masked, clip-space depth is in [0, 1]. Raster state is another matter: see
/// Device::reset_raster_state.
void set_assumed_state(const Functions& gl);

/// Saves the host's GL state and sets what rendering assumes. The destructor restores all state of OpenGL 4.5
/// that rendering changes, of all draw buffers, viewports and binding points:
///
/// - framebuffers, program, vertex array, indirect buffers, active texture unit;
/// - textures, samplers, images and indexed buffers, at the binding points that rendering uses;
/// - viewports, depth ranges, clip control; depth, cull, polygon, provoking-vertex, blend, colour-mask and
///   clear state;
/// - all capabilities that would change the picture, such as the scissor test or clip distances.
///
/// Transform feedback of the host is paused meanwhile. Pixel transfers save their own state where they
/// happen. What cannot be restored is listed at Renderer::render. Conditional rendering must not be active,
/// because OpenGL cannot tell whether it is. State that OpenGL 4.6 or extensions add is not looked at.
class HostState {
 public:
    /// `gl` must outlive the object. Without `keeps`, nothing is saved, and nothing restored.
    HostState(const Functions& gl, bool keeps);
    ~HostState();
    HostState(const HostState&) = delete;
    HostState& operator=(const HostState&) = delete;

 private:
    std::vector<std::function<void()>> restore_;  ///< in the order in which they are called
};

}  // namespace candela::gl
