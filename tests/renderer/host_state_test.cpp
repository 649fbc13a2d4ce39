#include <doctest/doctest.h>

#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "renderer/device_of.hpp"
#include "tests/renderer/scene_builder.hpp"

using namespace candela;

namespace {

constexpr glm::uvec2 size{32, 24};

/// All GL state that rendering might change.
struct HostView {
    std::vector<GLfloat> values;
    bool operator==(const HostView&) const = default;
};

HostView host_view(const gl::Functions& gl) {
    HostView view;
    const auto add_values = [&](int what, std::size_t count) {
        std::array<GLfloat, 4> values{};
        gl.GetFloatv(static_cast<GLenum>(what), values.data());
        view.values.insert(view.values.end(), values.begin(),
                           values.begin() + static_cast<std::ptrdiff_t>(count));
    };
    for (const int what :
         {GL_DRAW_FRAMEBUFFER_BINDING, GL_READ_FRAMEBUFFER_BINDING, GL_CURRENT_PROGRAM,
          GL_VERTEX_ARRAY_BINDING, GL_ACTIVE_TEXTURE, GL_DEPTH_FUNC, GL_FRONT_FACE, GL_CULL_FACE_MODE,
          GL_CLIP_ORIGIN, GL_CLIP_DEPTH_MODE, GL_DEPTH_WRITEMASK, GL_DEPTH_CLEAR_VALUE, GL_STENCIL_FUNC,
          GL_BLEND_SRC_RGB, GL_UNPACK_ALIGNMENT, GL_UNPACK_ROW_LENGTH, GL_PACK_ALIGNMENT, GL_LINE_WIDTH,
          GL_POLYGON_OFFSET_FACTOR}) {
        add_values(what, 1);
    }
    add_values(GL_DEPTH_RANGE, 2);
    for (const int what : {GL_VIEWPORT, GL_SCISSOR_BOX, GL_COLOR_WRITEMASK, GL_COLOR_CLEAR_VALUE}) {
        add_values(what, 4);
    }
    std::array<GLint, 2> polygon_mode{};  // some drivers still return front and back separately
    gl.GetIntegerv(GL_POLYGON_MODE, polygon_mode.data());
    view.values.push_back(static_cast<GLfloat>(polygon_mode[0]));
    for (const int what :
         {GL_BLEND, GL_COLOR_LOGIC_OP, GL_CULL_FACE, GL_DEPTH_CLAMP, GL_DEPTH_TEST, GL_FRAMEBUFFER_SRGB,
          GL_MULTISAMPLE, GL_POLYGON_OFFSET_FILL, GL_PRIMITIVE_RESTART, GL_RASTERIZER_DISCARD, GL_SAMPLE_MASK,
          GL_SCISSOR_TEST, GL_STENCIL_TEST, GL_TEXTURE_CUBE_MAP_SEAMLESS}) {
        view.values.push_back(gl.IsEnabled(static_cast<GLenum>(what)) == GL_TRUE ? 1.0F : 0.0F);
    }
    return view;
}

/// A host with its own objects.
struct Host {
    const gl::Functions& gl;
    GLuint vertex_array;
    GLuint buffer;
};

struct Oddity {
    std::string name;
    std::function<void(const Host&)> set;
};

const std::vector<Oddity>& oddities() {
    static const std::vector<Oddity> all = {
        {"nothing", [](const Host&) {}},
        {"depth range", [](const Host& host) { host.gl.DepthRangef(0.6F, 0.2F); }},
        {"depth mask", [](const Host& host) { host.gl.DepthMask(GL_FALSE); }},
        {"depth test",
         [](const Host& host) {
             host.gl.Enable(GL_DEPTH_TEST);
             host.gl.DepthFunc(GL_NEVER);
         }},
        {"depth clamp", [](const Host& host) { host.gl.Enable(GL_DEPTH_CLAMP); }},
        {"clip control",
         [](const Host& host) { host.gl.ClipControl(GL_UPPER_LEFT, GL_NEGATIVE_ONE_TO_ONE); }},
        {"polygon mode", [](const Host& host) { host.gl.PolygonMode(GL_FRONT_AND_BACK, GL_LINE); }},
        {"polygon offset",
         [](const Host& host) {
             host.gl.Enable(GL_POLYGON_OFFSET_FILL);
             host.gl.PolygonOffset(50.0F, 5000.0F);
         }},
        {"culling",
         [](const Host& host) {
             host.gl.Enable(GL_CULL_FACE);
             host.gl.CullFace(GL_FRONT_AND_BACK);
             host.gl.FrontFace(GL_CW);
         }},
        {"blending",
         [](const Host& host) {
             host.gl.Enable(GL_BLEND);
             host.gl.BlendFunc(GL_ZERO, GL_ONE);
         }},
        {"colour mask", [](const Host& host) { host.gl.ColorMask(GL_FALSE, GL_TRUE, GL_FALSE, GL_FALSE); }},
        {"scissor",
         [](const Host& host) {
             host.gl.Enable(GL_SCISSOR_TEST);
             host.gl.Scissor(1, 1, 2, 2);
         }},
        {"stencil",
         [](const Host& host) {
             host.gl.Enable(GL_STENCIL_TEST);
             host.gl.StencilFunc(GL_NEVER, 1, 1);
         }},
        {"logic op", [](const Host& host) { host.gl.Enable(GL_COLOR_LOGIC_OP); }},
        {"sample mask",
         [](const Host& host) {
             host.gl.Enable(GL_SAMPLE_MASK);
             host.gl.SampleMaski(0, 0);
         }},
        {"discard", [](const Host& host) { host.gl.Enable(GL_RASTERIZER_DISCARD); }},
        {"primitive restart",
         [](const Host& host) {
             host.gl.Enable(GL_PRIMITIVE_RESTART);
             host.gl.PrimitiveRestartIndex(2);
         }},
        {"sRGB", [](const Host& host) { host.gl.Enable(GL_FRAMEBUFFER_SRGB); }},
        {"seamless cubes", [](const Host& host) { host.gl.Enable(GL_TEXTURE_CUBE_MAP_SEAMLESS); }},
        {"viewport", [](const Host& host) { host.gl.Viewport(3, 4, 5, 6); }},
        {"clear values",
         [](const Host& host) {
             host.gl.ClearColor(1, 2, 3, 4);
             host.gl.ClearDepthf(0.5F);
         }},
        {"unpacking",
         [](const Host& host) {
             host.gl.PixelStorei(GL_UNPACK_ROW_LENGTH, 100);
             host.gl.PixelStorei(GL_UNPACK_ALIGNMENT, 8);
         }},
        {"unpack buffer", [](const Host& host) { host.gl.BindBuffer(GL_PIXEL_UNPACK_BUFFER, host.buffer); }},
        {"bindings", [](const Host& host) {
             host.gl.BindVertexArray(host.vertex_array);
             host.gl.ActiveTexture(GL_TEXTURE3);
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

}  // namespace

TEST_SUITE("host state") {
    TEST_CASE("the host's GL state neither changes the picture nor is changed") {
        const Scene scene = textured_scene();
        std::map<ShadingPath, Picture> usual;
        for (const Oddity& oddity : oddities()) {
            CAPTURE(oddity.name);
            const auto context = make_current_context();
            TestedRenderer renderer(context->get_proc());
            const gl::VertexArray array(device_of(renderer), "host's");
            const gl::Buffer buffer(device_of(renderer), "host's", 4096);
            const RenderTarget target(device_of(renderer), size);
            const gl::Functions& gl = device_of(renderer).gl();
            oddity.set({gl, array.name(), buffer.name()});
            for (const ShadingPath path : {ShadingPath::forward, ShadingPath::deferred}) {
                CAPTURE(to_string(path));
                REQUIRE(renderer.configure(small_configuration(path)).empty());
                const HostView before = host_view(gl);
                renderer.render(scene.world, scene.camera, target.target());
                CHECK(host_view(gl) == before);
                const Picture picture = target.read();
                CHECK(picture == usual.try_emplace(path, picture).first->second);
                renderer.invalidate();
            }
            CHECK(mean(usual[ShadingPath::forward]) > 0.01);
            for (const gl::DebugMessage& message : device_of(renderer).take_messages()) {
                CAPTURE(message.text);
                CHECK_FALSE(message.is_error());
            }
        }
    }
}
