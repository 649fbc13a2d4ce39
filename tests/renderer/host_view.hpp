#pragma once

#include <array>
#include <initializer_list>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "renderer/gl/objects.hpp"
#include "renderer/gl/texture.hpp"

namespace candela {

/// Functions of OpenGL 4.5 that a host may use and the library does not.
#define HOST_FUNCTIONS(X)                             \
    X(BeginQuery, BEGINQUERY)                         \
    X(BeginTransformFeedback, BEGINTRANSFORMFEEDBACK) \
    X(BindProgramPipeline, BINDPROGRAMPIPELINE)       \
    X(BindRenderbuffer, BINDRENDERBUFFER)             \
    X(BlendColor, BLENDCOLOR)                         \
    X(BlendEquationi, BLENDEQUATIONI)                 \
    X(ClampColor, CLAMPCOLOR)                         \
    X(ClearStencil, CLEARSTENCIL)                     \
    X(CreateProgramPipelines, CREATEPROGRAMPIPELINES) \
    X(CreateRenderbuffers, CREATERENDERBUFFERS)       \
    X(EndQuery, ENDQUERY)                             \
    X(EndTransformFeedback, ENDTRANSFORMFEEDBACK)     \
    X(GetQueryiv, GETQUERYIV)                         \
    X(Hint, HINT)                                     \
    X(LineWidth, LINEWIDTH)                           \
    X(LogicOp, LOGICOP)                               \
    X(MinSampleShading, MINSAMPLESHADING)             \
    X(PatchParameterfv, PATCHPARAMETERFV)             \
    X(PatchParameteri, PATCHPARAMETERI)               \
    X(PointParameterf, POINTPARAMETERF)               \
    X(PointSize, POINTSIZE)                           \
    X(SampleCoverage, SAMPLECOVERAGE)                 \
    X(ScissorIndexed, SCISSORINDEXED)                 \
    X(StencilMask, STENCILMASK)                       \
    X(StencilOpSeparate, STENCILOPSEPARATE)           \
    X(TransformFeedbackVaryings, TRANSFORMFEEDBACKVARYINGS)

struct HostFunctions {
#define HOST_FUNCTION(name, capitals) PFNGL##capitals##PROC name = nullptr;
    HOST_FUNCTIONS(HOST_FUNCTION)
#undef HOST_FUNCTION
};

inline HostFunctions load_host_functions(const gl::GetProc& proc) {
    HostFunctions functions;
#define LOAD_FUNCTION(name, capitals) \
    functions.name = reinterpret_cast<PFNGL##capitals##PROC>(proc("gl" #name));
    HOST_FUNCTIONS(LOAD_FUNCTION)
#undef LOAD_FUNCTION
    return functions;
}

/// A host with its own objects.
class Host {
 public:
    Host(gl::Device& device, const gl::GetProc& proc)
        : gl(device.gl()),
          more(load_host_functions(proc)),
          vertex_array(device, "host's"),
          buffer(device, "host's", 4096),
          flat(device, "host's", {.size = {4, 4}}),
          layers(device, "host's", {.size = {4, 4}, .shape = TextureShape::array, .layers = 3}),
          cubes(device, "host's", {.size = {4, 4}, .shape = TextureShape::cube_array, .layers = 6}),
          sampler(device, "host's", {.min_filter = GL_NEAREST, .wrap_u = GL_REPEAT}),
          framebuffer(device, "host's") {
        gl.SamplerParameteri(sampler.name(), GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
        gl.SamplerParameteri(sampler.name(), GL_TEXTURE_COMPARE_FUNC, GL_NEVER);
        framebuffer.attach_colour(0, flat.name());
    }

    /// A program that writes one float per vertex into a transform-feedback buffer.
    [[nodiscard]] GLuint make_program() const {
        const char* const text =
            "#version 450 core\nout float x; void main() { x = 1.0; gl_Position = vec4(0.0); }";
        const GLuint shader = gl.CreateShader(GL_VERTEX_SHADER);
        gl.ShaderSource(shader, 1, &text, nullptr);
        gl.CompileShader(shader);
        const GLuint program = gl.CreateProgram();
        gl.AttachShader(program, shader);
        const char* const varying = "x";
        more.TransformFeedbackVaryings(program, 1, &varying, GL_INTERLEAVED_ATTRIBS);
        gl.LinkProgram(program);
        gl.DeleteShader(shader);
        return program;
    }

    const gl::Functions& gl;
    HostFunctions more;
    gl::VertexArray vertex_array;
    gl::Buffer buffer;
    gl::Texture flat;
    gl::Texture layers;
    gl::Texture cubes;
    gl::Sampler sampler;
    gl::Framebuffer framebuffer;
};

/// Of queries that a host may have active.
inline constexpr std::array query_targets{GL_SAMPLES_PASSED, GL_ANY_SAMPLES_PASSED, GL_PRIMITIVES_GENERATED,
                                          GL_TIME_ELAPSED, GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN};

/// All GL state that rendering might change, by a name for messages.
class HostView {
 public:
    explicit HostView(const Host& host) : host_(&host), gl_(&host.gl) {
        add_values();
        add_capabilities();
        add_draw_buffers();
        add_viewports();
        add_texture_units();
        add_images();
        add_indexed_buffers();
        for (const int target : query_targets) {
            GLint current = 0;
            host_->more.GetQueryiv(static_cast<GLenum>(target), GL_CURRENT_QUERY, &current);
            add("query", target, 0, {static_cast<double>(current)});
        }
    }

    /// Names of what differs.
    [[nodiscard]] std::string differences(const HostView& other) const {
        std::string names;
        for (const auto& [name, value] : values_) {
            if (other.values_.at(name) != value) names += name + ' ';
        }
        return names;
    }

 private:
    void add(const char* group, int what, GLuint index, std::vector<double> value) {
        values_[std::string(group) + ' ' + std::to_string(what) + '[' + std::to_string(index) + ']'] =
            std::move(value);
    }
    [[nodiscard]] GLint get(int what) const {
        GLint value = 0;
        gl_->GetIntegerv(static_cast<GLenum>(what), &value);
        return value;
    }
    [[nodiscard]] GLuint count(int what) const { return static_cast<GLuint>(get(what)); }
    void add_at(const char* group, std::initializer_list<int> all, GLuint index) {
        for (const int what : all) {
            GLint64 value = 0;
            gl_->GetInteger64i_v(static_cast<GLenum>(what), index, &value);
            add(group, what, index, {static_cast<double>(value)});
        }
    }

    void add_values() {
        for (const int what : {GL_ACTIVE_TEXTURE,
                               GL_ARRAY_BUFFER_BINDING,
                               GL_ATOMIC_COUNTER_BUFFER_BINDING,
                               GL_CLAMP_READ_COLOR,
                               GL_CLIP_DEPTH_MODE,
                               GL_CLIP_ORIGIN,
                               GL_COPY_READ_BUFFER_BINDING,
                               GL_COPY_WRITE_BUFFER_BINDING,
                               GL_CULL_FACE_MODE,
                               GL_CURRENT_PROGRAM,
                               GL_DEBUG_GROUP_STACK_DEPTH,
                               GL_DEPTH_FUNC,
                               GL_DEPTH_WRITEMASK,
                               GL_DISPATCH_INDIRECT_BUFFER_BINDING,
                               GL_DRAW_BUFFER0,
                               GL_DRAW_BUFFER1,
                               GL_DRAW_FRAMEBUFFER_BINDING,
                               GL_DRAW_INDIRECT_BUFFER_BINDING,
                               GL_FRAGMENT_SHADER_DERIVATIVE_HINT,
                               GL_FRONT_FACE,
                               GL_LINE_SMOOTH_HINT,
                               GL_LOGIC_OP_MODE,
                               GL_PATCH_VERTICES,
                               GL_PIXEL_PACK_BUFFER_BINDING,
                               GL_PIXEL_UNPACK_BUFFER_BINDING,
                               GL_POLYGON_MODE,
                               GL_POLYGON_SMOOTH_HINT,
                               GL_PRIMITIVE_RESTART_INDEX,
                               GL_PROGRAM_PIPELINE_BINDING,
                               GL_PROVOKING_VERTEX,
                               GL_READ_BUFFER,
                               GL_READ_FRAMEBUFFER_BINDING,
                               GL_RENDERBUFFER_BINDING,
                               GL_SAMPLE_COVERAGE_INVERT,
                               GL_SHADER_STORAGE_BUFFER_BINDING,
                               GL_STENCIL_BACK_FAIL,
                               GL_STENCIL_BACK_FUNC,
                               GL_STENCIL_BACK_PASS_DEPTH_PASS,
                               GL_STENCIL_BACK_REF,
                               GL_STENCIL_BACK_VALUE_MASK,
                               GL_STENCIL_BACK_WRITEMASK,
                               GL_STENCIL_CLEAR_VALUE,
                               GL_STENCIL_FAIL,
                               GL_STENCIL_FUNC,
                               GL_STENCIL_PASS_DEPTH_PASS,
                               GL_STENCIL_REF,
                               GL_STENCIL_VALUE_MASK,
                               GL_STENCIL_WRITEMASK,
                               GL_TEXTURE_COMPRESSION_HINT,
                               GL_TRANSFORM_FEEDBACK_ACTIVE,
                               GL_TRANSFORM_FEEDBACK_BINDING,
                               GL_TRANSFORM_FEEDBACK_BUFFER_BINDING,
                               GL_TRANSFORM_FEEDBACK_PAUSED,
                               GL_UNIFORM_BUFFER_BINDING,
                               GL_VERTEX_ARRAY_BINDING,
                               GL_PACK_ALIGNMENT,
                               GL_PACK_IMAGE_HEIGHT,
                               GL_PACK_LSB_FIRST,
                               GL_PACK_ROW_LENGTH,
                               GL_PACK_SKIP_IMAGES,
                               GL_PACK_SKIP_PIXELS,
                               GL_PACK_SKIP_ROWS,
                               GL_PACK_SWAP_BYTES,
                               GL_UNPACK_ALIGNMENT,
                               GL_UNPACK_IMAGE_HEIGHT,
                               GL_UNPACK_LSB_FIRST,
                               GL_UNPACK_ROW_LENGTH,
                               GL_UNPACK_SKIP_IMAGES,
                               GL_UNPACK_SKIP_PIXELS,
                               GL_UNPACK_SKIP_ROWS,
                               GL_UNPACK_SWAP_BYTES}) {
            std::array<GLint, 2> value{};  // some drivers return two polygon modes
            gl_->GetIntegerv(static_cast<GLenum>(what), value.data());
            add("value", what, 0, {static_cast<double>(value[0])});
        }
        for (const int what : {GL_BLEND_COLOR, GL_COLOR_CLEAR_VALUE, GL_DEPTH_CLEAR_VALUE, GL_LINE_WIDTH,
                               GL_MIN_SAMPLE_SHADING_VALUE, GL_PATCH_DEFAULT_INNER_LEVEL,
                               GL_PATCH_DEFAULT_OUTER_LEVEL, GL_POINT_FADE_THRESHOLD_SIZE, GL_POINT_SIZE,
                               GL_POLYGON_OFFSET_FACTOR, GL_POLYGON_OFFSET_UNITS, GL_SAMPLE_COVERAGE_VALUE}) {
            std::array<GLfloat, 4> value{};
            gl_->GetFloatv(static_cast<GLenum>(what), value.data());
            add("floats", what, 0, {value.begin(), value.end()});
        }
        add_at("value", {GL_SAMPLE_MASK_VALUE}, 0);
    }

    void add_capabilities() {
        for (const int what : {GL_BLEND,
                               GL_COLOR_LOGIC_OP,
                               GL_CULL_FACE,
                               GL_DEBUG_OUTPUT,
                               GL_DEBUG_OUTPUT_SYNCHRONOUS,
                               GL_DEPTH_CLAMP,
                               GL_DEPTH_TEST,
                               GL_DITHER,
                               GL_FRAMEBUFFER_SRGB,
                               GL_LINE_SMOOTH,
                               GL_MULTISAMPLE,
                               GL_POLYGON_OFFSET_FILL,
                               GL_POLYGON_OFFSET_LINE,
                               GL_POLYGON_OFFSET_POINT,
                               GL_POLYGON_SMOOTH,
                               GL_PRIMITIVE_RESTART,
                               GL_PRIMITIVE_RESTART_FIXED_INDEX,
                               GL_PROGRAM_POINT_SIZE,
                               GL_RASTERIZER_DISCARD,
                               GL_SAMPLE_ALPHA_TO_COVERAGE,
                               GL_SAMPLE_ALPHA_TO_ONE,
                               GL_SAMPLE_COVERAGE,
                               GL_SAMPLE_MASK,
                               GL_SAMPLE_SHADING,
                               GL_SCISSOR_TEST,
                               GL_STENCIL_TEST,
                               GL_TEXTURE_CUBE_MAP_SEAMLESS}) {
            add("capability", what, 0, {gl_->IsEnabled(static_cast<GLenum>(what)) == GL_TRUE ? 1.0 : 0.0});
        }
        for (GLuint i = 0; i < count(GL_MAX_CLIP_DISTANCES); ++i) {
            add("clip distance", 0, i, {gl_->IsEnabled(GL_CLIP_DISTANCE0 + i) == GL_TRUE ? 1.0 : 0.0});
        }
    }

    void add_draw_buffers() {
        for (GLuint i = 0; i < count(GL_MAX_DRAW_BUFFERS); ++i) {
            add_at("draw buffer",
                   {GL_BLEND_EQUATION_RGB, GL_BLEND_EQUATION_ALPHA, GL_BLEND_SRC_RGB, GL_BLEND_DST_RGB,
                    GL_BLEND_SRC_ALPHA, GL_BLEND_DST_ALPHA},
                   i);
            std::array<GLboolean, 4> mask{};
            gl_->GetBooleani_v(GL_COLOR_WRITEMASK, i, mask.data());
            add("draw buffer", GL_COLOR_WRITEMASK, i, {mask.begin(), mask.end()});
            add("draw buffer", GL_BLEND, i, {gl_->IsEnabledi(GL_BLEND, i) == GL_TRUE ? 1.0 : 0.0});
        }
    }

    void add_viewports() {
        for (GLuint i = 0; i < count(GL_MAX_VIEWPORTS); ++i) {
            std::array<GLfloat, 4> viewport{};
            std::array<GLdouble, 2> depths{};
            std::array<GLint, 4> scissor{};
            gl_->GetFloati_v(GL_VIEWPORT, i, viewport.data());
            gl_->GetDoublei_v(GL_DEPTH_RANGE, i, depths.data());
            gl_->GetIntegeri_v(GL_SCISSOR_BOX, i, scissor.data());
            add("viewport", GL_VIEWPORT, i, {viewport.begin(), viewport.end()});
            add("viewport", GL_DEPTH_RANGE, i, {depths.begin(), depths.end()});
            add("viewport", GL_SCISSOR_BOX, i, {scissor.begin(), scissor.end()});
            add("viewport", GL_SCISSOR_TEST, i, {gl_->IsEnabledi(GL_SCISSOR_TEST, i) == GL_TRUE ? 1.0 : 0.0});
        }
    }

    void add_texture_units() {
        const auto active = static_cast<GLenum>(get(GL_ACTIVE_TEXTURE));
        for (GLuint i = 0; i < count(GL_MAX_COMBINED_TEXTURE_IMAGE_UNITS); ++i) {
            gl_->ActiveTexture(GL_TEXTURE0 + i);
            for (const int what :
                 {GL_TEXTURE_BINDING_1D, GL_TEXTURE_BINDING_1D_ARRAY, GL_TEXTURE_BINDING_2D,
                  GL_TEXTURE_BINDING_2D_ARRAY, GL_TEXTURE_BINDING_2D_MULTISAMPLE,
                  GL_TEXTURE_BINDING_2D_MULTISAMPLE_ARRAY, GL_TEXTURE_BINDING_3D, GL_TEXTURE_BINDING_BUFFER,
                  GL_TEXTURE_BINDING_CUBE_MAP, GL_TEXTURE_BINDING_CUBE_MAP_ARRAY,
                  GL_TEXTURE_BINDING_RECTANGLE, GL_SAMPLER_BINDING}) {
                add("texture unit", what, i, {static_cast<double>(get(what))});
            }
        }
        gl_->ActiveTexture(active);
    }

    void add_images() {
        for (GLuint i = 0; i < count(GL_MAX_IMAGE_UNITS); ++i) {
            add_at("image unit",
                   {GL_IMAGE_BINDING_NAME, GL_IMAGE_BINDING_LEVEL, GL_IMAGE_BINDING_LAYERED,
                    GL_IMAGE_BINDING_LAYER, GL_IMAGE_BINDING_ACCESS, GL_IMAGE_BINDING_FORMAT},
                   i);
        }
    }

    void add_indexed_buffers() {
        for (GLuint i = 0; i < count(GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS); ++i) {
            add_at("storage buffer",
                   {GL_SHADER_STORAGE_BUFFER_BINDING, GL_SHADER_STORAGE_BUFFER_START,
                    GL_SHADER_STORAGE_BUFFER_SIZE},
                   i);
        }
        for (GLuint i = 0; i < count(GL_MAX_UNIFORM_BUFFER_BINDINGS); ++i) {
            add_at("uniform buffer",
                   {GL_UNIFORM_BUFFER_BINDING, GL_UNIFORM_BUFFER_START, GL_UNIFORM_BUFFER_SIZE}, i);
        }
        for (GLuint i = 0; i < count(GL_MAX_TRANSFORM_FEEDBACK_BUFFERS); ++i) {
            add_at("transform feedback",
                   {GL_TRANSFORM_FEEDBACK_BUFFER_BINDING, GL_TRANSFORM_FEEDBACK_BUFFER_START,
                    GL_TRANSFORM_FEEDBACK_BUFFER_SIZE},
                   i);
        }
    }

    const Host* host_;
    const gl::Functions* gl_;
    std::map<std::string, std::vector<double>> values_;
};

}  // namespace candela
