#include "renderer/gl/host_state.hpp"

#include "shaders/bindings.glsl"

namespace candela::gl {
namespace {

// Capabilities that would change the picture if the host had enabled them.
constexpr std::array<GLenum, 17> capabilities{
    GL_BLEND, GL_COLOR_LOGIC_OP, GL_CULL_FACE, GL_DEPTH_CLAMP, GL_DEPTH_TEST, GL_FRAMEBUFFER_SRGB,
    GL_MULTISAMPLE, GL_POLYGON_OFFSET_FILL, GL_PRIMITIVE_RESTART, GL_PRIMITIVE_RESTART_FIXED_INDEX,
    GL_RASTERIZER_DISCARD, GL_SAMPLE_ALPHA_TO_COVERAGE, GL_SAMPLE_COVERAGE, GL_SAMPLE_MASK, GL_SCISSOR_TEST,
    GL_STENCIL_TEST,
    // Seamless filtering would compare depths across two faces of a cube shadow map.
    GL_TEXTURE_CUBE_MAP_SEAMLESS};

}  // namespace

HostState::HostState(const Functions& gl)
    : gl_(&gl),
      draw_framebuffer_(get(GL_DRAW_FRAMEBUFFER_BINDING)),
      read_framebuffer_(get(GL_READ_FRAMEBUFFER_BINDING)),
      program_(get(GL_CURRENT_PROGRAM)),
      vertex_array_(get(GL_VERTEX_ARRAY_BINDING)),
      active_texture_(get(GL_ACTIVE_TEXTURE)),
      depth_func_(get(GL_DEPTH_FUNC)),
      front_face_(get(GL_FRONT_FACE)),
      cull_face_(get(GL_CULL_FACE_MODE)),
      clip_origin_(get(GL_CLIP_ORIGIN)),
      clip_depth_(get(GL_CLIP_DEPTH_MODE)),
      blend_equation_{get(GL_BLEND_EQUATION_RGB), get(GL_BLEND_EQUATION_ALPHA)},
      blend_factors_{get(GL_BLEND_SRC_RGB), get(GL_BLEND_DST_RGB), get(GL_BLEND_SRC_ALPHA),
                     get(GL_BLEND_DST_ALPHA)} {
    gl.GetBooleanv(GL_DEPTH_WRITEMASK, &depth_mask_);
    gl.GetBooleanv(GL_COLOR_WRITEMASK, colour_mask_.data());
    gl.GetIntegerv(GL_VIEWPORT, viewport_.data());
    gl.GetIntegerv(GL_POLYGON_MODE, polygon_mode_.data());
    gl.GetFloatv(GL_DEPTH_RANGE, depth_range_.data());
    gl.GetFloatv(GL_COLOR_CLEAR_VALUE, clear_colour_.data());
    gl.GetFloatv(GL_DEPTH_CLEAR_VALUE, &clear_depth_);
    gl.GetFloatv(GL_POLYGON_OFFSET_FACTOR, &polygon_offset_factor_);
    gl.GetFloatv(GL_POLYGON_OFFSET_UNITS, &polygon_offset_units_);
    for (const GLenum capability : capabilities) {
        enabled_.push_back(gl.IsEnabled(capability) == GL_TRUE);
        gl.Disable(capability);
    }
    gl.ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    gl.DepthRangef(0.0F, 1.0F);
    gl.CullFace(GL_BACK);
    gl.PolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    gl.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

HostState::~HostState() {
    const Functions& gl = *gl_;
    for (GLuint unit = 0; unit <= UNIT_LAST; ++unit) {
        gl.BindTextureUnit(unit, 0);
        gl.BindSampler(unit, 0);
    }
    for (GLuint binding = 0; binding <= BINDING_LAST; ++binding) {
        gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, 0);
    }
    for (GLuint binding = 0; binding <= UNIFORMS_LAST; ++binding) {
        gl.BindBufferBase(GL_UNIFORM_BUFFER, binding, 0);
    }
    for (GLuint image = 0; image <= IMAGE_LAST; ++image) {
        gl.BindImageTexture(image, 0, 0, GL_FALSE, 0, GL_READ_ONLY, GL_R8);
    }
    gl.BindBuffer(GL_DRAW_INDIRECT_BUFFER, 0);
    gl.BindBuffer(GL_DISPATCH_INDIRECT_BUFFER, 0);
    for (std::size_t i = 0; i < capabilities.size(); ++i) {
        if (enabled_[i]) {
            gl.Enable(capabilities[i]);
        } else {
            gl.Disable(capabilities[i]);
        }
    }
    gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, static_cast<GLuint>(draw_framebuffer_));
    gl.BindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(read_framebuffer_));
    gl.UseProgram(static_cast<GLuint>(program_));
    gl.BindVertexArray(static_cast<GLuint>(vertex_array_));
    gl.ActiveTexture(static_cast<GLenum>(active_texture_));
    gl.DepthFunc(static_cast<GLenum>(depth_func_));
    gl.FrontFace(static_cast<GLenum>(front_face_));
    gl.CullFace(static_cast<GLenum>(cull_face_));
    gl.PolygonMode(GL_FRONT_AND_BACK, static_cast<GLenum>(polygon_mode_[0]));
    gl.ClipControl(static_cast<GLenum>(clip_origin_), static_cast<GLenum>(clip_depth_));
    gl.BlendEquationSeparate(static_cast<GLenum>(blend_equation_[0]),
                             static_cast<GLenum>(blend_equation_[1]));
    gl.BlendFuncSeparate(static_cast<GLenum>(blend_factors_[0]), static_cast<GLenum>(blend_factors_[1]),
                         static_cast<GLenum>(blend_factors_[2]), static_cast<GLenum>(blend_factors_[3]));
    gl.DepthRangef(depth_range_[0], depth_range_[1]);
    gl.DepthMask(depth_mask_);
    gl.ColorMask(colour_mask_[0], colour_mask_[1], colour_mask_[2], colour_mask_[3]);
    gl.Viewport(viewport_[0], viewport_[1], viewport_[2], viewport_[3]);
    gl.ClearColor(clear_colour_[0], clear_colour_[1], clear_colour_[2], clear_colour_[3]);
    gl.ClearDepthf(clear_depth_);
    gl.PolygonOffset(polygon_offset_factor_, polygon_offset_units_);
}

GLint HostState::get(GLenum what) const {
    GLint value = 0;
    gl_->GetIntegerv(what, &value);
    return value;
}

}  // namespace candela::gl
