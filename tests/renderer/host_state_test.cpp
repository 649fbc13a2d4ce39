#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <candela/inspection.hpp>
#include "renderer/facade/device_of.hpp"
#include "tests/renderer/host_view.hpp"
#include "tests/renderer/scene_builder.hpp"

TEST_SUITE("host state") {

using namespace candela;

namespace {

constexpr glm::uvec2 size{32, 24};

/// Something that a host may have set. What forbids something else until it has ended has an `undo`; the rest
/// stays set while further oddities are added to it.
struct Oddity {
    std::string name;
    std::function<void(const Host&)> set;
    std::function<void(const Host&)> undo = [](const Host&) {};
};

const std::vector<Oddity>& depth_and_raster_oddities() {
    static const std::vector<Oddity> all = {
        {"depth range", [](const Host& host) { host.gl.DepthRangef(0.6F, 0.2F); }},
        {"depth range of one viewport", [](const Host& host) { host.gl.DepthRangeIndexed(0, 1.0, 0.9); }},
        {"depth ranges of other viewports", [](const Host& host) { host.gl.DepthRangeIndexed(3, 0.1, 0.2); }},
        {"depth mask", [](const Host& host) { host.gl.DepthMask(GL_FALSE); }},
        {"depth test",
         [](const Host& host) {
             host.gl.Enable(GL_DEPTH_TEST);
             host.gl.DepthFunc(GL_NEVER);
         }},
        {"depth clamp", [](const Host& host) { host.gl.Enable(GL_DEPTH_CLAMP); }},
        {"clip control",
         [](const Host& host) { host.gl.ClipControl(GL_UPPER_LEFT, GL_NEGATIVE_ONE_TO_ONE); }},
        {"clip distances",
         [](const Host& host) {
             for (GLuint i = 0; i < 8; ++i) host.gl.Enable(GL_CLIP_DISTANCE0 + i);
         }},
        {"polygon mode", [](const Host& host) { host.gl.PolygonMode(GL_FRONT_AND_BACK, GL_LINE); }},
        {"polygon offset",
         [](const Host& host) {
             host.gl.Enable(GL_POLYGON_OFFSET_FILL);
             host.gl.PolygonOffset(50.0F, 5000.0F);
         }},
        {"smooth polygons and lines",
         [](const Host& host) {
             host.gl.Enable(GL_POLYGON_SMOOTH);
             host.gl.Enable(GL_LINE_SMOOTH);
             host.more.Hint(GL_POLYGON_SMOOTH_HINT, GL_NICEST);
         }},
        {"lines and points",
         [](const Host& host) {
             host.more.LineWidth(1.0F);
             host.more.PointSize(9.0F);
             host.more.PointParameterf(GL_POINT_FADE_THRESHOLD_SIZE, 3.0F);
             host.gl.Enable(GL_PROGRAM_POINT_SIZE);
         }},
        {"culling",
         [](const Host& host) {
             host.gl.Enable(GL_CULL_FACE);
             host.gl.CullFace(GL_FRONT_AND_BACK);
             host.gl.FrontFace(GL_CW);
         }},
        {"provoking vertex", [](const Host& host) { host.gl.ProvokingVertex(GL_FIRST_VERTEX_CONVENTION); }},
        {"patches",
         [](const Host& host) {
             const std::array levels{7.0F, 6.0F, 5.0F, 4.0F};
             host.more.PatchParameteri(GL_PATCH_VERTICES, 5);
             host.more.PatchParameterfv(GL_PATCH_DEFAULT_OUTER_LEVEL, levels.data());
         }},
        {"discard", [](const Host& host) { host.gl.Enable(GL_RASTERIZER_DISCARD); }},
        {"primitive restart",
         [](const Host& host) {
             host.gl.Enable(GL_PRIMITIVE_RESTART);
             host.gl.PrimitiveRestartIndex(2);
         }},
        {"primitive restart at the largest index",
         [](const Host& host) { host.gl.Enable(GL_PRIMITIVE_RESTART_FIXED_INDEX); }},
        {"viewport", [](const Host& host) { host.gl.Viewport(3, 4, 5, 6); }},
        {"viewports",
         [](const Host& host) {
             const std::array rectangle{1.5F, 2.5F, 3.5F, 4.5F};
             for (const GLuint i : {0U, 2U, 15U}) host.gl.ViewportIndexedfv(i, rectangle.data());
         }},
        {"scissor",
         [](const Host& host) {
             host.gl.Enable(GL_SCISSOR_TEST);
             host.gl.Scissor(1, 1, 2, 2);
         }},
        {"scissor of single viewports", [](const Host& host) {
             for (const GLuint i : {0U, 5U}) {
                 host.gl.Enablei(GL_SCISSOR_TEST, i);
                 host.more.ScissorIndexed(i, 1, 2, 3, 4);
             }
         }}};
    return all;
}

const std::vector<Oddity>& pixel_oddities() {
    static const std::vector<Oddity> all = {
        {"blending",
         [](const Host& host) {
             host.gl.Enable(GL_BLEND);
             host.gl.BlendFunc(GL_ZERO, GL_ONE);
             host.more.BlendColor(0.1F, 0.2F, 0.3F, 0.4F);
         }},
        {"blending of single draw buffers",
         [](const Host& host) {
             host.gl.Disablei(GL_BLEND, 0);
             for (const GLuint i : {1U, 2U, 7U}) {
                 host.gl.Enablei(GL_BLEND, i);
                 host.gl.BlendFuncSeparatei(i, GL_ZERO, GL_SRC_ALPHA, GL_DST_COLOR, GL_ZERO);
                 host.more.BlendEquationi(i, i == 1 ? GL_MIN : GL_FUNC_REVERSE_SUBTRACT);
             }
         }},
        {"colour mask", [](const Host& host) { host.gl.ColorMask(GL_FALSE, GL_TRUE, GL_FALSE, GL_FALSE); }},
        {"colour masks of single draw buffers",
         [](const Host& host) {
             host.gl.ColorMaski(0, GL_TRUE, GL_FALSE, GL_TRUE, GL_TRUE);
             host.gl.ColorMaski(1, GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
             host.gl.ColorMaski(7, GL_FALSE, GL_TRUE, GL_TRUE, GL_TRUE);
         }},
        {"stencil",
         [](const Host& host) {
             host.gl.Enable(GL_STENCIL_TEST);
             host.gl.StencilFunc(GL_NEVER, 1, 1);
             host.more.StencilOpSeparate(GL_BACK, GL_INCR, GL_DECR, GL_INVERT);
             host.more.StencilMask(0x0F);
             host.more.ClearStencil(3);
         }},
        {"logic op",
         [](const Host& host) {
             host.gl.Enable(GL_COLOR_LOGIC_OP);
             host.more.LogicOp(GL_XOR);
         }},
        {"dithering", [](const Host& host) { host.gl.Disable(GL_DITHER); }},
        {"multisampling", [](const Host& host) { host.gl.Disable(GL_MULTISAMPLE); }},
        {"sample mask",
         [](const Host& host) {
             host.gl.Enable(GL_SAMPLE_MASK);
             host.gl.SampleMaski(0, 0);
         }},
        {"sample coverage",
         [](const Host& host) {
             host.gl.Enable(GL_SAMPLE_COVERAGE);
             host.more.SampleCoverage(0.0F, GL_FALSE);
         }},
        {"alpha to coverage",
         [](const Host& host) {
             host.gl.Enable(GL_SAMPLE_ALPHA_TO_COVERAGE);
             host.gl.Enable(GL_SAMPLE_ALPHA_TO_ONE);
         }},
        {"sample shading",
         [](const Host& host) {
             host.gl.Enable(GL_SAMPLE_SHADING);
             host.more.MinSampleShading(1.0F);
         }},
        {"sRGB", [](const Host& host) { host.gl.Enable(GL_FRAMEBUFFER_SRGB); }},
        {"seamless cubes", [](const Host& host) { host.gl.Enable(GL_TEXTURE_CUBE_MAP_SEAMLESS); }},
        {"clear values",
         [](const Host& host) {
             host.gl.ClearColor(1, 2, 3, 4);
             host.gl.ClearDepthf(0.5F);
         }},
        {"unpacking",
         [](const Host& host) {
             for (const int what : {GL_UNPACK_ROW_LENGTH, GL_UNPACK_IMAGE_HEIGHT}) {
                 host.gl.PixelStorei(static_cast<GLenum>(what), 100);
             }
             for (const int what :
                  {GL_UNPACK_SKIP_PIXELS, GL_UNPACK_SKIP_ROWS, GL_UNPACK_SKIP_IMAGES, GL_UNPACK_SWAP_BYTES}) {
                 host.gl.PixelStorei(static_cast<GLenum>(what), 1);
             }
             host.gl.PixelStorei(GL_UNPACK_ALIGNMENT, 8);
         }},
        {"packing",
         [](const Host& host) {
             host.gl.PixelStorei(GL_PACK_ROW_LENGTH, 100);
             host.gl.PixelStorei(GL_PACK_SKIP_PIXELS, 3);
             host.more.ClampColor(GL_CLAMP_READ_COLOR, GL_TRUE);
         }},
        {"hints", [](const Host& host) {
             host.more.Hint(GL_FRAGMENT_SHADER_DERIVATIVE_HINT, GL_FASTEST);
             host.more.Hint(GL_TEXTURE_COMPRESSION_HINT, GL_NICEST);
         }}};
    return all;
}

const std::vector<Oddity>& binding_oddities() {
    static const std::vector<Oddity> all = {
        {"vertex array and active texture unit",
         [](const Host& host) {
             host.gl.BindVertexArray(host.vertex_array.name());
             host.gl.ActiveTexture(GL_TEXTURE3);
         }},
        {"buffers",
         [](const Host& host) {
             for (const int target :
                  {GL_ARRAY_BUFFER, GL_ATOMIC_COUNTER_BUFFER, GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER,
                   GL_DISPATCH_INDIRECT_BUFFER, GL_DRAW_INDIRECT_BUFFER, GL_PIXEL_PACK_BUFFER,
                   GL_PIXEL_UNPACK_BUFFER, GL_SHADER_STORAGE_BUFFER, GL_TEXTURE_BUFFER, GL_UNIFORM_BUFFER}) {
                 host.gl.BindBuffer(static_cast<GLenum>(target), host.buffer.name());
             }
         }},
        {"indexed buffers",
         [](const Host& host) {
             for (GLuint i = 0; i < 16; ++i) {
                 host.gl.BindBufferBase(GL_UNIFORM_BUFFER, i, host.buffer.name());
                 host.gl.BindBufferRange(GL_SHADER_STORAGE_BUFFER, i, host.buffer.name(), 256, 64 + 4 * i);
             }
             host.gl.BindBufferRange(GL_UNIFORM_BUFFER, 1, host.buffer.name(), 1024, 16);
             host.gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, 3, host.buffer.name());
             host.gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, 4, 0);
             host.gl.BindBuffer(GL_UNIFORM_BUFFER, 0);
         }},
        {"textures",
         [](const Host& host) {
             for (GLuint unit = 0; unit < 16; ++unit) {
                 host.gl.ActiveTexture(GL_TEXTURE0 + unit);
                 host.gl.BindTexture(GL_TEXTURE_2D, host.flat.name());
                 host.gl.BindTexture(GL_TEXTURE_2D_ARRAY, host.layers.name());
                 if (unit % 2 == 0) host.gl.BindTexture(GL_TEXTURE_CUBE_MAP_ARRAY, host.cubes.name());
             }
         }},
        {"samplers",
         [](const Host& host) {
             for (GLuint unit = 0; unit < 16; ++unit) host.gl.BindSampler(unit, host.sampler.name());
         }},
        {"images",
         [](const Host& host) {
             for (GLuint unit = 0; unit < 8; ++unit) {
                 host.gl.BindImageTexture(unit, host.layers.name(), 0, GL_FALSE, 2, GL_WRITE_ONLY, GL_RGBA8);
             }
         }},
        {"framebuffers",
         [](const Host& host) {
             GLuint renderbuffer = 0;
             host.more.CreateRenderbuffers(1, &renderbuffer);
             host.more.BindRenderbuffer(GL_RENDERBUFFER, renderbuffer);
             host.gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, host.framebuffer.name());
             host.gl.BindFramebuffer(GL_READ_FRAMEBUFFER, host.framebuffer.name());
         }},
        {"program", [](const Host& host) { host.gl.UseProgram(host.make_program()); }},
        {"program pipeline",
         [](const Host& host) {
             GLuint pipeline = 0;
             host.more.CreateProgramPipelines(1, &pipeline);
             host.more.BindProgramPipeline(pipeline);
         }},
        {"transform feedback",
         [](const Host& host) {
             host.gl.BindBufferRange(GL_TRANSFORM_FEEDBACK_BUFFER, 0, host.buffer.name(), 64, 128);
             host.gl.UseProgram(host.make_program());
             host.more.BeginTransformFeedback(GL_POINTS);
         },
         [](const Host& host) { host.more.EndTransformFeedback(); }},
        {"paused transform feedback",
         [](const Host& host) {
             host.gl.BindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, host.buffer.name());
             host.gl.UseProgram(host.make_program());
             host.more.BeginTransformFeedback(GL_POINTS);
             host.gl.PauseTransformFeedback();
         },
         [](const Host& host) { host.more.EndTransformFeedback(); }},
        {"queries",
         [](const Host& host) {
             for (const int target : query_targets) {
                 GLuint query = 0;
                 if (target == GL_ANY_SAMPLES_PASSED) continue;  // shares its counter with SAMPLES_PASSED
                 host.gl.CreateQueries(static_cast<GLenum>(target), 1, &query);
                 host.more.BeginQuery(static_cast<GLenum>(target), query);
             }
         },
         [](const Host& host) {
             for (const int target : query_targets) {
                 if (target != GL_ANY_SAMPLES_PASSED) host.more.EndQuery(static_cast<GLenum>(target));
             }
         }},
        {"debug groups", [](const Host& host) {
             GLint most = 0;
             host.gl.GetIntegerv(GL_MAX_DEBUG_GROUP_STACK_DEPTH, &most);
             for (GLint i = 1; i < most; ++i) {
                 host.gl.PushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, 0, -1, "host's");
             }
         }}};
    return all;
}

/// The Cornell box with a textured square in it.
Scene textured_scene() {
    Scene scene = cornell_box();
    Material material;
    material.base_colour_texture = std::make_shared<const Image>(
        Image{.width = 3, .height = 5, .texels = std::vector(15, glm::u8vec4(30, 200, 90, 255))});
    add(scene.world, at({0, 0.5F, 0.5F}),
        MeshInstance{square(0.5F, std::make_shared<const Material>(std::move(material)))});
    return scene;
}

Configuration small_configuration(ShadingPath path) {
    Configuration configuration = linear_configuration(path);
    configuration.vpls.count = 16;
    configuration.shadows = {.cube_resolution = 32, .map_resolution = 32};
    return configuration;
}

/// A picture to tone-map.
std::vector<glm::vec3> gradient() {
    std::vector<glm::vec3> pixels;
    for (std::uint32_t i = 0; i < size.x * size.y; ++i) {
        pixels.emplace_back(static_cast<float>(i), 1.0F, 0.5F);
    }
    return pixels;
}

/// A renderer in a context where a host sets one oddity after another. A renderer that resets all but one of
/// them shows what that one does, so they need no context each.
class OddHost {
 public:
    OddHost() { black_.upload(std::vector(std::size_t{4} * size.x * size.y, std::byte{0})); }

    void check_harmless(const std::vector<Oddity>& oddities) {
        const std::vector<Picture> usual = pictures();
        CHECK(mean(usual[0]) > 0.01);
        CHECK(usual[2].pixels == gradient());  // the tone curve is off
        CHECK(mean(usual[3]) > 0.01);
        CHECK(usual[4] == usual[1]);
        CHECK(mean(usual[5]) > 0.01);
        for (const Oddity& oddity : oddities) {
            CAPTURE(oddity.name);
            oddity.set(host_);
            CHECK(pictures() == usual);
            oddity.undo(host_);
            for (const gl::DebugMessage& message : device_of(renderer_).take_messages()) {
                CAPTURE(message.text);
                CHECK_FALSE(message.is_error());
            }
            CHECK(host_.gl.GetError() == GL_NO_ERROR);
        }
    }

 private:
    /// Renders the scene with two paths, tone-maps a picture, inspects a resource and draws a difference.
    /// Checks that the host's state stays.
    std::vector<Picture> pictures() {
        std::vector<Picture> pictures;
        const auto take = [&](const auto& draw) {
            const HostView before(host_);
            draw();
            CHECK(HostView(host_).differences(before) == "");
            pictures.push_back(target_.read());
            renderer_.invalidate();
        };
        const auto render = [&] { renderer_.render(scene_.world, scene_.camera, target_.target()); };
        for (const ShadingPath path : {ShadingPath::forward, ShadingPath::deferred}) {
            REQUIRE(renderer_.configure(small_configuration(path)).empty());
            take(render);
        }
        take([&] { renderer_.tone_map(gradient(), target_.target()); });
        Configuration exposed = small_configuration(ShadingPath::deferred);
        exposed.tone_map = {.enabled = true, .automatic_exposure = true};
        REQUIRE(renderer_.configure(exposed).empty());
        take([&] { renderer_.tone_map(gradient(), target_.target()); });
        REQUIRE(renderer_.configure(small_configuration(ShadingPath::deferred)).empty());
        REQUIRE(inspector_.show(Inspection{.resource = "depth"}).empty());
        take(render);
        const GLuint inspected = inspector_.result().texture;
        take([&] { draw_difference(renderer_, inspected, black_.name(), 1.0F, target_.target()); });
        REQUIRE(inspector_.show({}).empty());
        return pictures;
    }

    const Scene scene_ = textured_scene();
    const std::unique_ptr<HeadlessContext> context_ = make_current_context();
    TestedRenderer renderer_{context_->get_proc()};
    const Host host_{device_of(renderer_), context_->get_proc()};
    const RenderTarget target_{device_of(renderer_), size};
    ResourceInspector inspector_{renderer_};
    gl::Texture black_{device_of(renderer_), "black", {size, Format::rgba8}};
};

}  // namespace

TEST_CASE("the host's depth and rasterisation state neither changes the picture nor is changed") {
    OddHost().check_harmless(depth_and_raster_oddities());
}

TEST_CASE("the host's pixel state neither changes the picture nor is changed") {
    OddHost().check_harmless(pixel_oddities());
}

TEST_CASE("the host's bindings neither change the picture nor are changed") {
    OddHost().check_harmless(binding_oddities());
}

TEST_CASE("transform feedback of the host goes on after a frame and contains nothing of it") {
    const auto context = make_current_context();
    TestedRenderer renderer(context->get_proc());
    REQUIRE(renderer.configure(small_configuration(ShadingPath::forward)).empty());
    Host host(device_of(renderer), context->get_proc());
    const RenderTarget target(device_of(renderer), size);
    const Scene scene = textured_scene();
    constexpr float untouched = -1.0F;
    host.buffer.upload(std::vector(1024, untouched));
    host.gl.BindVertexArray(host.vertex_array.name());
    host.gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, host.framebuffer.name());
    host.gl.BindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, host.buffer.name());
    host.gl.UseProgram(host.make_program());
    host.more.BeginTransformFeedback(GL_POINTS);
    host.gl.DrawArrays(GL_POINTS, 0, 2);
    renderer.render(scene.world, scene.camera, target.target());
    host.gl.DrawArrays(GL_POINTS, 0, 3);
    host.more.EndTransformFeedback();
    std::vector expected(1024, untouched);
    std::fill_n(expected.begin(), 5, 1.0F);
    CHECK(host.buffer.download<float>() == expected);
    CHECK(host.gl.GetError() == GL_NO_ERROR);
}

TEST_CASE("a program that the host has deleted while it was current is gone, without an error") {
    const auto context = make_current_context();
    TestedRenderer renderer(context->get_proc());
    REQUIRE(renderer.configure(small_configuration(ShadingPath::forward)).empty());
    const Host host(device_of(renderer), context->get_proc());
    const RenderTarget target(device_of(renderer), size);
    const Scene scene = textured_scene();
    const GLuint program = host.make_program();
    host.gl.UseProgram(program);
    host.gl.DeleteProgram(program);
    renderer.render(scene.world, scene.camera, target.target());
    GLint current = -1;
    host.gl.GetIntegerv(GL_CURRENT_PROGRAM, &current);
    CHECK(current == 0);
    CHECK(host.gl.GetError() == GL_NO_ERROR);
}

TEST_CASE("a pending error of the host is still there after a renderer was made, used and destroyed") {
    const auto context = make_current_context();
    const gl::Functions gl = gl::load_functions(context->get_proc());
    const Scene scene = textured_scene();
    gl.Enable(GL_RENDERER);  // no capability
    {
        TestedRenderer renderer(context->get_proc());
        const RenderTarget target(device_of(renderer), size);
        for (const ShadingPath path : {ShadingPath::forward_plus, ShadingPath::clustered_deferred}) {
            REQUIRE(renderer.configure(small_configuration(path)).empty());
            renderer.render(scene.world, scene.camera, target.target());
        }
        static_cast<void>(renderer.report());
        static_cast<void>(renderer.take_frames(true));
    }
    CHECK(gl.GetError() == GL_INVALID_ENUM);
    CHECK(gl.GetError() == GL_NO_ERROR);
}

}  // TEST_SUITE("host state")
