#pragma once

#include <array>
#include <vector>

#include "renderer/gl/functions.hpp"

namespace candela::gl {

/// Saves the host's GL state and sets what rendering assumes: clip-space depth in [0, 1] (glClipControl), and
/// none of the capabilities enabled that would change the picture. The destructor restores framebuffers,
/// program, vertex array, active texture unit, viewport, capabilities, and depth, blend, cull, polygon,
/// colour-mask, clear and clip-control state. Texture units, samplers, image units, indexed buffer bindings
/// and indirect buffers that rendering uses are left unbound.
class HostState {
 public:
    explicit HostState(const Functions& gl);
    ~HostState();
    HostState(const HostState&) = delete;
    HostState& operator=(const HostState&) = delete;

 private:
    [[nodiscard]] GLint get(GLenum what) const;

    const Functions* gl_;
    GLint draw_framebuffer_;
    GLint read_framebuffer_;
    GLint program_;
    GLint vertex_array_;
    GLint active_texture_;
    GLint depth_func_;
    GLint front_face_;
    GLint cull_face_;
    GLint clip_origin_;
    GLint clip_depth_;
    std::array<GLint, 2> blend_equation_;  // RGB, alpha
    std::array<GLint, 4> blend_factors_;   // source RGB, destination RGB, source alpha, destination alpha
    GLboolean depth_mask_ = GL_TRUE;
    std::array<GLint, 4> viewport_{};
    std::array<GLint, 2> polygon_mode_{};  // only [0] is used; some drivers write two values
    std::array<GLboolean, 4> colour_mask_{};
    std::array<GLfloat, 2> depth_range_{};
    std::array<GLfloat, 4> clear_colour_{};
    GLfloat clear_depth_ = 0.0F;
    GLfloat polygon_offset_factor_ = 0.0F;
    GLfloat polygon_offset_units_ = 0.0F;
    std::vector<bool> enabled_;
};

}  // namespace candela::gl
