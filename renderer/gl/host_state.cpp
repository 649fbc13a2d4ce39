#include "renderer/gl/host_state.hpp"

#include <array>
#include <cstddef>
#include <utility>

#include "shaders/bindings.glsl"

namespace candela::gl {
namespace {

// Capabilities that would change the picture if the host had enabled them. Blending and the scissor test are
// saved with the draw buffers and viewports.
constexpr std::array<GLenum, 18> capabilities{
    GL_COLOR_LOGIC_OP, GL_CULL_FACE, GL_DEPTH_CLAMP, GL_DEPTH_TEST, GL_FRAMEBUFFER_SRGB, GL_MULTISAMPLE,
    GL_POLYGON_OFFSET_FILL, GL_POLYGON_SMOOTH, GL_PRIMITIVE_RESTART, GL_PRIMITIVE_RESTART_FIXED_INDEX,
    GL_RASTERIZER_DISCARD, GL_SAMPLE_ALPHA_TO_COVERAGE, GL_SAMPLE_ALPHA_TO_ONE, GL_SAMPLE_COVERAGE,
    GL_SAMPLE_MASK, GL_SAMPLE_SHADING, GL_STENCIL_TEST,
    // Seamless filtering would compare depths across two faces of a cube shadow map.
    GL_TEXTURE_CUBE_MAP_SEAMLESS};

/// A texture target that rendering binds, and the query for what is bound there.
struct TextureTarget {
    GLenum target;
    GLenum binding;
};
constexpr std::array<TextureTarget, 4> texture_targets{
    {{GL_TEXTURE_2D, GL_TEXTURE_BINDING_2D},
     {GL_TEXTURE_2D_ARRAY, GL_TEXTURE_BINDING_2D_ARRAY},
     {GL_TEXTURE_CUBE_MAP_ARRAY, GL_TEXTURE_BINDING_CUBE_MAP_ARRAY},
     {GL_TEXTURE_BUFFER, GL_TEXTURE_BINDING_BUFFER}}};

/// A target of indexed buffers, with the queries for what is bound there.
struct IndexedTarget {
    GLenum target;
    GLenum binding;
    GLenum start;
    GLenum size;
    GLuint count;  ///< of the binding points that rendering uses
};
constexpr std::array<IndexedTarget, 2> indexed_targets{
    {{GL_SHADER_STORAGE_BUFFER, GL_SHADER_STORAGE_BUFFER_BINDING, GL_SHADER_STORAGE_BUFFER_START,
      GL_SHADER_STORAGE_BUFFER_SIZE, BINDING_LAST + 1},
     {GL_UNIFORM_BUFFER, GL_UNIFORM_BUFFER_BINDING, GL_UNIFORM_BUFFER_START, GL_UNIFORM_BUFFER_SIZE,
      UNIFORMS_LAST + 1}}};

GLint get(const Functions& gl, GLenum what) {
    GLint value = 0;
    gl.GetIntegerv(what, &value);
    return value;
}

GLint get_at(const Functions& gl, GLenum what, GLuint index) {
    GLint value = 0;
    gl.GetIntegeri_v(what, index, &value);
    return value;
}

GLuint get_unsigned_at(const Functions& gl, GLenum what, GLuint index) {
    return static_cast<GLuint>(get_at(gl, what, index));
}

void set_enabled_at(const Functions& gl, GLenum capability, GLuint index, bool enabled) {
    if (enabled) {
        gl.Enablei(capability, index);
    } else {
        gl.Disablei(capability, index);
    }
}

std::vector<GLenum> all_capabilities(const Functions& gl) {
    std::vector<GLenum> all(capabilities.begin(), capabilities.end());
    const GLuint clip_distances = get_unsigned(gl, GL_MAX_CLIP_DISTANCES);
    for (GLuint i = 0; i < clip_distances; ++i) {
        all.push_back(GL_CLIP_DISTANCE0 + i);
    }
    return all;
}

// Each of the following functions saves a part of the state, and returns what restores it.

using Restore = std::function<void()>;

Restore pause_transform_feedback(const Functions& gl) {
    const bool running =
        get(gl, GL_TRANSFORM_FEEDBACK_ACTIVE) == GL_TRUE && get(gl, GL_TRANSFORM_FEEDBACK_PAUSED) == GL_FALSE;
    if (!running) return [] {};
    gl.PauseTransformFeedback();
    return [&gl] { gl.ResumeTransformFeedback(); };
}

Restore save_objects(const Functions& gl) {
    return
        [&gl, draw = get_unsigned(gl, GL_DRAW_FRAMEBUFFER_BINDING),
         read = get_unsigned(gl, GL_READ_FRAMEBUFFER_BINDING), program = get_unsigned(gl, GL_CURRENT_PROGRAM),
         vertex_array = get_unsigned(gl, GL_VERTEX_ARRAY_BINDING),
         draw_indirect = get_unsigned(gl, GL_DRAW_INDIRECT_BUFFER_BINDING),
         dispatch_indirect = get_unsigned(gl, GL_DISPATCH_INDIRECT_BUFFER_BINDING)] {
            gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, draw);
            gl.BindFramebuffer(GL_READ_FRAMEBUFFER, read);
            gl.UseProgram(gl.IsProgram(program) == GL_TRUE ? program : 0);
            gl.BindVertexArray(vertex_array);
            gl.BindBuffer(GL_DRAW_INDIRECT_BUFFER, draw_indirect);
            gl.BindBuffer(GL_DISPATCH_INDIRECT_BUFFER, dispatch_indirect);
        };
}

Restore save_texture_units(const Functions& gl) {
    struct Unit {
        std::array<GLuint, texture_targets.size()> textures;
        GLuint sampler;
    };
    std::array<Unit, UNIT_LAST + 1> units{};
    const GLuint active = get_unsigned(gl, GL_ACTIVE_TEXTURE);
    for (GLuint i = 0; i < units.size(); ++i) {
        gl.ActiveTexture(GL_TEXTURE0 + i);
        for (std::size_t target = 0; target < texture_targets.size(); ++target) {
            units[i].textures[target] = get_unsigned(gl, texture_targets[target].binding);
        }
        units[i].sampler = get_unsigned(gl, GL_SAMPLER_BINDING);
    }
    return [&gl, units, active] {
        for (GLuint i = 0; i < units.size(); ++i) {
            gl.ActiveTexture(GL_TEXTURE0 + i);
            for (std::size_t target = 0; target < texture_targets.size(); ++target) {
                gl.BindTexture(texture_targets[target].target, units[i].textures[target]);
            }
            gl.BindSampler(i, units[i].sampler);
        }
        gl.ActiveTexture(active);
    };
}

Restore save_images(const Functions& gl) {
    struct Image {
        GLuint texture;
        GLint level;
        GLboolean layered;
        GLint layer;
        GLenum access;
        GLenum format;
    };
    std::array<Image, IMAGE_LAST + 1> images{};
    for (GLuint i = 0; i < images.size(); ++i) {
        images[i] = {.texture = get_unsigned_at(gl, GL_IMAGE_BINDING_NAME, i),
                     .level = get_at(gl, GL_IMAGE_BINDING_LEVEL, i),
                     .layered = static_cast<GLboolean>(get_at(gl, GL_IMAGE_BINDING_LAYERED, i)),
                     .layer = get_at(gl, GL_IMAGE_BINDING_LAYER, i),
                     .access = get_unsigned_at(gl, GL_IMAGE_BINDING_ACCESS, i),
                     .format = get_unsigned_at(gl, GL_IMAGE_BINDING_FORMAT, i)};
    }
    return [&gl, images] {
        for (GLuint i = 0; i < images.size(); ++i) {
            const Image& image = images[i];
            gl.BindImageTexture(i, image.texture, image.level, image.layered, image.layer, image.access,
                                image.format);
        }
    };
}

Restore save_indexed_buffers(const Functions& gl, const IndexedTarget& target) {
    struct Binding {
        GLuint buffer;
        GLint64 start;
        GLint64 size;
    };
    std::vector<Binding> bindings(target.count);
    for (GLuint i = 0; i < target.count; ++i) {
        bindings[i].buffer = get_unsigned_at(gl, target.binding, i);
        gl.GetInteger64i_v(target.start, i, &bindings[i].start);
        gl.GetInteger64i_v(target.size, i, &bindings[i].size);
    }
    return [&gl, &target, bindings = std::move(bindings), generic = get_unsigned(gl, target.binding)] {
        for (GLuint i = 0; i < bindings.size(); ++i) {
            const auto& [buffer, start, size] = bindings[i];
            if (size == 0) {  // the whole buffer, or none
                gl.BindBufferBase(target.target, i, buffer);
            } else {
                gl.BindBufferRange(target.target, i, buffer, static_cast<GLintptr>(start),
                                   static_cast<GLsizeiptr>(size));
            }
        }
        gl.BindBuffer(target.target, generic);  // each indexed binding also sets this one
    };
}

Restore save_viewports(const Functions& gl) {
    struct Viewport {
        std::array<GLfloat, 4> rectangle;
        std::array<GLdouble, 2> depth_range;
        bool scissor_test;
    };
    std::vector<Viewport> viewports(get_unsigned(gl, GL_MAX_VIEWPORTS));
    for (GLuint i = 0; i < viewports.size(); ++i) {
        gl.GetFloati_v(GL_VIEWPORT, i, viewports[i].rectangle.data());
        gl.GetDoublei_v(GL_DEPTH_RANGE, i, viewports[i].depth_range.data());
        viewports[i].scissor_test = gl.IsEnabledi(GL_SCISSOR_TEST, i) == GL_TRUE;
    }
    return [&gl, viewports = std::move(viewports)] {
        for (GLuint i = 0; i < viewports.size(); ++i) {
            const Viewport& viewport = viewports[i];
            gl.ViewportIndexedfv(i, viewport.rectangle.data());
            gl.DepthRangeIndexed(i, viewport.depth_range[0], viewport.depth_range[1]);
            set_enabled_at(gl, GL_SCISSOR_TEST, i, viewport.scissor_test);
        }
    };
}

Restore save_draw_buffers(const Functions& gl) {
    struct DrawBuffer {
        bool blends;
        std::array<GLenum, 2> equation;  // RGB, alpha
        std::array<GLenum, 4> factors;   // source RGB, destination RGB, source alpha, destination alpha
        std::array<GLboolean, 4> mask;
    };
    std::vector<DrawBuffer> buffers(get_unsigned(gl, GL_MAX_DRAW_BUFFERS));
    for (GLuint i = 0; i < buffers.size(); ++i) {
        buffers[i] = {
            .blends = gl.IsEnabledi(GL_BLEND, i) == GL_TRUE,
            .equation = {get_unsigned_at(gl, GL_BLEND_EQUATION_RGB, i),
                         get_unsigned_at(gl, GL_BLEND_EQUATION_ALPHA, i)},
            .factors = {get_unsigned_at(gl, GL_BLEND_SRC_RGB, i), get_unsigned_at(gl, GL_BLEND_DST_RGB, i),
                        get_unsigned_at(gl, GL_BLEND_SRC_ALPHA, i),
                        get_unsigned_at(gl, GL_BLEND_DST_ALPHA, i)},
            .mask = {}};
        gl.GetBooleani_v(GL_COLOR_WRITEMASK, i, buffers[i].mask.data());
    }
    return [&gl, buffers = std::move(buffers)] {
        for (GLuint i = 0; i < buffers.size(); ++i) {
            const auto& [blends, equation, factors, mask] = buffers[i];
            set_enabled_at(gl, GL_BLEND, i, blends);
            gl.BlendEquationSeparatei(i, equation[0], equation[1]);
            gl.BlendFuncSeparatei(i, factors[0], factors[1], factors[2], factors[3]);
            gl.ColorMaski(i, mask[0], mask[1], mask[2], mask[3]);
        }
    };
}

Restore save_capabilities(const Functions& gl) {
    std::vector<GLenum> all = all_capabilities(gl);
    std::vector<bool> enabled;
    enabled.reserve(all.size());
    for (const GLenum capability : all) {
        enabled.push_back(gl.IsEnabled(capability) == GL_TRUE);
    }
    return [&gl, all = std::move(all), enabled = std::move(enabled)] {
        for (std::size_t i = 0; i < all.size(); ++i) {
            set_enabled(gl, all[i], enabled[i]);
        }
    };
}

Restore save_rasterisation(const Functions& gl) {
    std::array<GLfloat, 2> offset{};
    std::array<GLint, 2> polygon_mode{};  // only [0] is used; some drivers write two values
    gl.GetFloatv(GL_POLYGON_OFFSET_FACTOR, &offset[0]);
    gl.GetFloatv(GL_POLYGON_OFFSET_UNITS, &offset[1]);
    gl.GetIntegerv(GL_POLYGON_MODE, polygon_mode.data());
    return [&gl, offset, mode = static_cast<GLenum>(polygon_mode[0]),
            front_face = get_unsigned(gl, GL_FRONT_FACE), cull_face = get_unsigned(gl, GL_CULL_FACE_MODE),
            clip_origin = get_unsigned(gl, GL_CLIP_ORIGIN), clip_depth = get_unsigned(gl, GL_CLIP_DEPTH_MODE),
            provoking_vertex = get_unsigned(gl, GL_PROVOKING_VERTEX)] {
        gl.PolygonOffset(offset[0], offset[1]);
        gl.PolygonMode(GL_FRONT_AND_BACK, mode);
        gl.FrontFace(front_face);
        gl.CullFace(cull_face);
        gl.ClipControl(clip_origin, clip_depth);
        gl.ProvokingVertex(provoking_vertex);
    };
}

Restore save_depth_and_clears(const Functions& gl) {
    GLboolean depth_mask = GL_TRUE;
    std::array<GLfloat, 4> clear_colour{};
    GLfloat clear_depth = 0.0F;
    gl.GetBooleanv(GL_DEPTH_WRITEMASK, &depth_mask);
    gl.GetFloatv(GL_COLOR_CLEAR_VALUE, clear_colour.data());
    gl.GetFloatv(GL_DEPTH_CLEAR_VALUE, &clear_depth);
    return [&gl, depth_mask, clear_colour, clear_depth, depth_func = get_unsigned(gl, GL_DEPTH_FUNC)] {
        gl.DepthFunc(depth_func);
        gl.DepthMask(depth_mask);
        gl.ClearColor(clear_colour[0], clear_colour[1], clear_colour[2], clear_colour[3]);
        gl.ClearDepthf(clear_depth);
    };
}

}  // namespace

void set_assumed_state(const Functions& gl) {
    for (GLuint i = 0; i <= UNIT_LAST; ++i) {
        gl.BindSampler(i, 0);
    }
    gl.DepthRangef(0.0F, 1.0F);
    gl.Disable(GL_SCISSOR_TEST);
    gl.Disable(GL_BLEND);
    gl.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    for (const GLenum capability : all_capabilities(gl)) {
        gl.Disable(capability);
    }
    gl.PolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    gl.CullFace(GL_BACK);
    gl.ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    gl.ProvokingVertex(GL_LAST_VERTEX_CONVENTION);  // drivers may round interpolated values in another way
}

HostState::HostState(const Functions& gl, bool keeps) {
    if (keeps) {
        // While transform feedback runs, the program can be neither changed nor restored.
        Restore resume = pause_transform_feedback(gl);
        restore_ = {save_objects(gl),
                    save_texture_units(gl),
                    save_images(gl),
                    save_indexed_buffers(gl, indexed_targets[0]),
                    save_indexed_buffers(gl, indexed_targets[1]),
                    save_viewports(gl),
                    save_draw_buffers(gl),
                    save_capabilities(gl),
                    save_rasterisation(gl),
                    save_depth_and_clears(gl),
                    std::move(resume)};
    }
    set_assumed_state(gl);
}

HostState::~HostState() {
    for (const Restore& restore : restore_) {
        restore();
    }
}

}  // namespace candela::gl
