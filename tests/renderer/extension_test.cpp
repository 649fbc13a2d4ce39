// Passes of a host in the frames of a renderer.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <candela/extension.hpp>
#include <candela/graph/describe.hpp>
#include <candela/graph/execute.hpp>
#include <candela/scene/tangents.hpp>
#include "renderer/facade/device_of.hpp"
#include "renderer/gl/compiling_program.hpp"
#include "tests/renderer/path_fixture.hpp"
#include "tests/renderer/texels.hpp"
#include "tests/throws.hpp"

TEST_SUITE("extensions") {

using namespace candela;

namespace {

constexpr glm::uvec2 size{24, 18};

/// The host's own component.
struct Gain {
    float factor = 1.0F;
    bool operator==(const Gain&) const = default;
};

float gain_of(const WorldReader& world) {
    float factor = 1.0F;
    for (const auto& [entity, gain] : world.view<Gain>()) {
        factor *= gain.factor;
    }
    return factor;
}

constexpr std::string_view triangle = R"(
void main() {
    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
})";
constexpr std::string_view scale = R"(
layout(binding = 3) uniform sampler2D radiance;
uniform float factor;
layout(location = 0) out vec4 scaled;
void main() { scaled = texelFetch(radiance, ivec2(gl_FragCoord.xy), 0) * vec4(vec3(factor), 1.0); })";

class ExtensionTests : public RenderFixture {
 protected:
    ExtensionTests() {
        Configuration configuration = linear_configuration();
        configuration.vpls.count = 32;
        configure(configuration);
    }

    /// Multiplies radiance by `factor(world)`, in a pass of this name.
    template <class Factor>
    [[nodiscard]] Extension scaling(std::string name, ExtensionPlace place, Factor factor) {
        const std::vector<gl::EmbeddedShader> files{{"triangle.vert", triangle}, {"scale.frag", scale}};
        const auto program = std::make_shared<gl::Program>(
            gl::compile(device, gl::ShaderLibrary{files}, {"triangle.vert", "scale.frag"}));
        const auto vertices = std::make_shared<gl::VertexArray>(device, "host's");
        Extension extension{.name = name, .place = place};
        extension.declare = [=, this](FrameGraph& graph, ViewFrame& frame) {
            frame.radiance = graph.add(name, [&](Pass& pass) {
                pass.read<Gain>();
                pass.read(*frame.radiance, {Usage::sampled, 3});
                const auto out = pass.write(graph.texture(name + " radiance", {frame.size, Format::rgba32f}),
                                            Usage::colour_target);
                pass.run([=, this](Execution& run) {
                    program->use({{"factor", factor(run.world())}});
                    vertices->bind();
                    device.gl().DrawArrays(GL_TRIANGLES, 0, 3);
                });
                return out;
            });
        };
        return extension;
    }

    Picture frame() { return render(scene, size); }

    Scene scene = cornell_box();
};

/// Covers the floor of the Cornell box; its normal texture tilts all normals, and 51/255 of indirect light
/// reaches it.
MeshInstance bumpy_floor() {
    const auto texel = [](glm::u8vec4 value) {
        return std::make_shared<const Image>(
            Image{.width = 1, .height = 1, .texels = {value}, .encoding = Encoding::linear});
    };
    Material material = *diffuse(glm::vec3(0.5F));
    material.normal_texture = texel({180, 140, 220, 255});
    material.occlusion_texture = texel({51, 0, 0, 255});
    Mesh mesh = *square(0.9F, std::make_shared<const Material>(std::move(material)));
    derive_tangents(mesh.primitives[0]);
    return {std::make_shared<const Mesh>(std::move(mesh))};
}

Picture operator*(float factor, Picture picture) {
    for (glm::vec3& pixel : picture.pixels) {
        pixel *= factor;
    }
    return picture;
}

}  // namespace

TEST_CASE_FIXTURE(ExtensionTests, "a pass of the host's is driven by its own component") {
    const Picture usual = frame();
    REQUIRE(renderer.extend(scaling("gain", ExtensionPlace::before_tone_map, gain_of)).empty());
    CHECK(frame() == usual);
    CHECK(frame() == usual);
    CHECK_FALSE(ran("gain"));
    CHECK_FALSE(ran("deferred"));
    const Entity knob = add(scene.world, Gain{2.0F});
    CHECK(frame() == 2.0F * usual);
    CHECK(ran("gain"));
    CHECK_FALSE(ran("deferred"));
    scene.world.destroy(knob);
    CHECK(frame() == usual);
    CHECK(describe_text(renderer.description()).find("gain radiance") != std::string::npos);
    renderer.remove_extension("gain");
    CHECK(frame() == usual);
    CHECK(describe_text(renderer.description()).find("gain") == std::string::npos);
}

TEST_CASE_FIXTURE(ExtensionTests, "extensions follow each other, in all views and configurations") {
    const Picture usual = frame();
    REQUIRE(
        renderer
            .extend(scaling("double", ExtensionPlace::after_shading, [](const WorldReader&) { return 2.0F; }))
            .empty());
    REQUIRE(renderer
                .extend(scaling("triple", ExtensionPlace::before_tone_map,
                                [](const WorldReader&) { return 3.0F; }))
                .empty());
    CHECK(frame() == 6.0F * usual);
    for (const ShadingPath path : {ShadingPath::forward, ShadingPath::clustered_deferred}) {
        Configuration configuration = renderer.configuration();
        configuration.path = path;
        configure(configuration);
        CHECK(relative_mean_square(frame(), 6.0F * usual) < 1e-10);  // paths differ by rounding
    }
    const RenderTarget second(device, size);
    const RenderTarget first(device, size);
    const std::vector<RenderView> views{{.camera = scene.camera, .target = first.target()},
                                        {.camera = scene.camera, .target = second.target()}};
    renderer.render(scene.world, views);
    CHECK(first.read() == second.read());
    CHECK(describe_text(renderer.description()).find("triple 2") != std::string::npos);
    // The same name replaces.
    REQUIRE(renderer
                .extend(scaling("triple", ExtensionPlace::before_tone_map,
                                [](const WorldReader&) { return 0.5F; }))
                .empty());
    CHECK(relative_mean_square(frame(), usual) < 1e-10);
}

TEST_CASE_FIXTURE(ExtensionTests,
                  "passes after shading come before blended surfaces, those before the tone map after them") {
    Scene pane = ground();
    pane.world.set(pane.light, looking({0, 1, 0}, {0, 0, 0}, {0, 0, 1}));
    pane.world.set(pane.light, DirectionalLight{.illuminance = 1.0F});
    Material material = *diffuse(glm::vec3(0.9F));
    material.alpha_mode = AlphaMode::blend;
    material.base_colour.a = 0.5F;
    add(pane.world, at({0, 0.5F, 0}),
        MeshInstance{square(4.0F, std::make_shared<const Material>(std::move(material)))});
    Configuration configuration = renderer.configuration();
    configuration.indirect = false;
    configure(configuration);
    const auto black = [](const WorldReader&) { return 0.0F; };
    REQUIRE(renderer.extend(scaling("black", ExtensionPlace::after_shading, black)).empty());
    // What the pane reflects, times its alpha; half floats.
    CHECK(render(pane, size).at(12, 9).r == doctest::Approx(0.5 * 0.9 / std::numbers::pi).epsilon(2e-3));
    REQUIRE(renderer.extend(scaling("black", ExtensionPlace::before_tone_map, black)).empty());
    CHECK(mean(render(pane, size)) == 0.0);
}

TEST_CASE_FIXTURE(ExtensionTests, "extensions get the parts that they need, on every path") {
    std::vector<ViewFrame> seen;
    Extension look{.name = "look", .place = ExtensionPlace::after_surfaces};
    look.needs = {.depth = true, .normal = true, .albedo = true};
    look.declare = [&](FrameGraph&, ViewFrame& parts) { seen.push_back(parts); };
    REQUIRE(renderer.extend(look).empty());
    look.name = "look later";
    look.place = ExtensionPlace::before_tone_map;
    look.needs = {.indirect = true};
    REQUIRE(renderer.extend(look).empty());
    for (const ShadingPath path : all_shading_paths) {
        CAPTURE(to_string(path));
        Configuration configuration = renderer.configuration();
        configuration.path = path;
        configuration.indirect = false;  // so that configuring declares the graph in any case
        configure(configuration);
        configuration.indirect = true;
        seen.clear();
        configure(configuration);
        REQUIRE(seen.size() == 2);
        CHECK(seen[0].depth);
        CHECK(seen[0].normal);
        CHECK(seen[0].albedo);
        CHECK_FALSE(seen[0].radiance);
        CHECK(seen[0].lit_surfels);
        CHECK(seen[1].indirect);
        CHECK(seen[1].radiance);
        CHECK(seen[1].list_count.has_value() == (info_of(path).lights != LightList::all));
    }
    CHECK(mean(frame()) > 0.01);
}

TEST_CASE_FIXTURE(ExtensionTests,
                  "extensions get what normal and occlusion textures do to surfaces, on every path") {
    struct Seen {
        TextureDesc desc;
        std::vector<glm::vec4> texels;
    };
    // Keeps what a part of the frame holds when the extension runs.
    const auto look = [&](std::string name, std::optional<TextureHandle> ViewFrame::*part, Seen& seen) {
        Extension extension{.name = name, .place = ExtensionPlace::before_tone_map};
        extension.needs = {.albedo = true, .indirect = true};
        extension.declare = [=, this, &seen](FrameGraph& graph, ViewFrame& frame) {
            const std::optional<TextureHandle> texture = frame.*part;
            if (!texture) return;
            graph.add(name, [&](Pass& pass) {
                pass.side_effect();
                pass.read(*texture, Usage::copy);
                pass.run([=, this, &seen](Execution& run) {
                    seen.desc = run.desc(*texture);
                    seen.texels = texels(device.gl(), {run.object(*texture), glm::uvec2(seen.desc.size)});
                });
            });
        };
        return extension;
    };
    Seen bumps, flow;
    REQUIRE(renderer.extend(look("bumps", &ViewFrame::bumps, bumps)).empty());
    REQUIRE(renderer.extend(look("flow", &ViewFrame::indirect_flow, flow)).empty());
    static_cast<void>(frame());
    CHECK(bumps.texels.empty());  // nothing is bumpy
    CHECK(flow.texels.empty());
    add(scene.world, at({0, 0.01F, 0}), bumpy_floor());
    for (const ShadingPath path : all_shading_paths) {
        CAPTURE(to_string(path));
        Configuration configuration = renderer.configuration();
        configuration.path = path;
        configure(configuration);
        bumps = flow = {};
        static_cast<void>(frame());
        CHECK(bumps.desc.format == Format::rgba32f);
        CHECK(flow.desc.format == Format::rgba32f);
        REQUIRE(bumps.texels.size() == std::size_t{size.x} * size.y);
        REQUIRE(flow.texels.size() == bumps.texels.size());
        const auto pixels_with = [&](float share) {
            return std::ranges::count_if(bumps.texels,
                                         [=](glm::vec4 texel) { return std::abs(texel.z - share) < 1e-6F; });
        };
        // The floor, and all else.
        CHECK(pixels_with(0.2F) > 10);
        CHECK(pixels_with(1.0F) > 10);
        // A sum of vectors is no longer than the sum of their lengths; both are rounded.
        CHECK(std::ranges::all_of(
            flow.texels, [](glm::vec4 texel) { return glm::length(glm::vec3(texel)) <= 1.0001F * texel.w; }));
        CHECK(std::ranges::any_of(flow.texels, [](glm::vec4 texel) { return texel.w > 0.0F; }));
    }
}

TEST_CASE_FIXTURE(ExtensionTests, "a faulty extension is refused by name and changes nothing") {
    const Picture usual = frame();
    const auto refused = [&](auto declare) {
        Extension extension{.name = "faulty"};
        extension.declare = declare;
        const std::vector<std::string> errors = renderer.extend(extension);
        CHECK(frame() == usual);
        CHECK_FALSE(ran("deferred"));
        REQUIRE(errors.size() == 1);
        return errors.front();
    };
    const auto twice = [](FrameGraph& graph, ViewFrame&) { graph.add("deferred", [](Pass&) {}); };
    CHECK(refused(twice).find("'deferred'") != std::string::npos);
    const auto unwritten = [](FrameGraph& graph, ViewFrame&) {
        graph.add("thirsty", [&](Pass& pass) {
            pass.side_effect();
            pass.read(graph.texture("nothing", {}), Usage::sampled);
        });
    };
    CHECK(refused(unwritten).find("'thirsty'") != std::string::npos);
    CHECK(refused([](FrameGraph&, ViewFrame&) { throw std::runtime_error("no such file"); }) ==
          "no such file");
}

TEST_CASE_FIXTURE(ExtensionTests,
                  "an extension that returns a part unlike the one that it was given is refused") {
    const Picture usual = frame();
    const auto refused = [&](ExtensionPlace place, auto change) {
        Extension extension{.name = "odd", .place = place};
        extension.declare = change;
        const std::vector<std::string> errors = renderer.extend(extension);
        CHECK(frame() == usual);
        REQUIRE(errors.size() == 1);
        return errors.front();
    };
    const auto written = [](FrameGraph& graph, const TextureDesc& desc) {
        return graph.add(
            "odd", [&](Pass& pass) { return pass.write(graph.texture("odd", desc), Usage::colour_target); });
    };
    const auto replacing = [&](TextureDesc desc) {
        return [=](FrameGraph& graph, ViewFrame& parts) { parts.radiance = written(graph, desc); };
    };
    CHECK(
        refused(ExtensionPlace::before_tone_map, replacing({size / 2U, Format::rgba32f})) ==
        "the extension 'odd' returns a part 'radiance' of 12x9 texels of rgba32f instead of 24x18 texels of "
        "rgba32f");
    CHECK(
        refused(ExtensionPlace::after_shading, replacing({size, Format::rgba16f})) ==
        "the extension 'odd' returns a part 'radiance' of 24x18 texels of rgba16f instead of 24x18 texels of "
        "rgba32f");
    CHECK(refused(ExtensionPlace::after_shading,
                  replacing({.size = size, .format = Format::rgba32f, .mips = 2}))
              .find("24x18 texels of rgba32f, 2 mip levels instead of") != std::string::npos);
    // Shading would overwrite it.
    CHECK(refused(ExtensionPlace::after_surfaces, replacing({size, Format::rgba32f})) ==
          "the extension 'odd' returns a part 'radiance', which it was not given");
    CHECK(refused(ExtensionPlace::before_tone_map, [](FrameGraph&, ViewFrame& parts) {
              parts.radiance.reset();
          }) == "the extension 'odd' removes the part 'radiance'");
    // A handle of nothing is found by compiling.
    CHECK(refused(ExtensionPlace::before_tone_map, [](FrameGraph&, ViewFrame& parts) {
              parts.radiance = TextureHandle{};
          }).find("tone-map") != std::string::npos);
    // An extension with a size of its own does until the size of the view is another.
    Extension fixed{.name = "fixed"};
    fixed.declare = [=](FrameGraph& graph, ViewFrame& parts) {
        parts.radiance = graph.add("fixed", [&](Pass& pass) {
            pass.read(*parts.radiance, Usage::copy);
            return pass.write(graph.texture("fixed", {size, Format::rgba32f}), Usage::copy);
        });
    };
    REQUIRE(renderer.extend(fixed).empty());
    static_cast<void>(frame());
    const RenderTarget larger(device, 2U * size);
    CHECK(throws<GraphError>([&] { renderer.render(scene.world, scene.camera, larger.target()); },
                             "of 24x18 texels of rgba32f instead of 48x36 texels of rgba32f"));
    renderer.remove_extension("fixed");
    CHECK(frame() == usual);
}

TEST_CASE_FIXTURE(ExtensionTests, "the GL state that a pass of the host's leaves behind changes no picture") {
    Material material = *diffuse(glm::vec3(0.2F, 0.9F, 0.4F));
    material.alpha_mode = AlphaMode::blend;
    material.base_colour.a = 0.5F;
    add(scene.world, at({0, 1, 0}),
        MeshInstance{square(0.3F, std::make_shared<const Material>(std::move(material)))});
    const gl::Texture texture(device, "host's", {.size = {4, 4}, .format = Format::rgba32f});
    const gl::Sampler sampler(device, "host's", {.min_filter = GL_NEAREST});
    const gl::Buffer buffer(device, "host's", 256);
    const gl::VertexArray vertices(device, "host's");
    gl::Framebuffer framebuffer(device, "host's");
    framebuffer.attach_colour(0, texture.name());
    const auto disturb = [&] {
        const gl::Functions& gl = device.gl();
        gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
        gl.UseProgram(0);
        vertices.bind();
        gl.Viewport(1, 1, 2, 2);
        gl.Scissor(0, 0, 3, 3);
        for (const int capability :
             {GL_SCISSOR_TEST, GL_BLEND, GL_DEPTH_TEST, GL_CULL_FACE, GL_COLOR_LOGIC_OP,
              GL_RASTERIZER_DISCARD, GL_STENCIL_TEST, GL_CLIP_DISTANCE0}) {
            gl.Enable(static_cast<GLenum>(capability));
        }
        gl.ColorMask(GL_FALSE, GL_TRUE, GL_FALSE, GL_FALSE);
        gl.DepthMask(GL_FALSE);
        gl.DepthFunc(GL_NEVER);
        gl.DepthRangef(0.5F, 0.6F);
        gl.BlendFuncSeparate(GL_ONE, GL_ONE, GL_ZERO, GL_ONE);
        gl.BlendEquation(GL_FUNC_REVERSE_SUBTRACT);
        gl.CullFace(GL_FRONT_AND_BACK);
        gl.FrontFace(GL_CW);
        gl.PolygonMode(GL_FRONT_AND_BACK, GL_POINT);
        gl.ClipControl(GL_UPPER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
        gl.ClearColor(1.0F, 0.5F, 0.25F, 0.0F);
        gl.ClearDepthf(0.7F);
        gl.PixelStorei(GL_UNPACK_ROW_LENGTH, 7);
        gl.BindBuffer(GL_PIXEL_UNPACK_BUFFER, buffer.name());
        gl.BindBuffer(GL_DRAW_INDIRECT_BUFFER, buffer.name());
        for (GLuint unit = 0; unit < 16; ++unit) {
            gl.BindTextureUnit(unit, texture.name());
            sampler.bind(unit);
        }
        for (GLuint index = 0; index < 8; ++index) {
            gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, index, buffer.name());
            gl.BindBufferBase(GL_UNIFORM_BUFFER, index, buffer.name());
            gl.BindImageTexture(index, texture.name(), 0, GL_FALSE, 0, GL_READ_WRITE, GL_RGBA32F);
        }
    };
    Extension careless;
    careless.declare = [&](FrameGraph& graph, ViewFrame& parts) {
        graph.add("careless", [&](Pass& pass) {
            pass.side_effect();
            const bool has_target = parts.radiance.has_value();
            if (has_target) parts.radiance = pass.write(*parts.radiance, Usage::colour_target);
            pass.run([=, &disturb, this](Execution&) {
                const GLenum nowhere = GL_NONE;
                const GLuint bound = gl::get_unsigned(device.gl(), GL_DRAW_FRAMEBUFFER_BINDING);
                if (has_target) device.gl().NamedFramebufferDrawBuffers(bound, 1, &nowhere);
                disturb();
            });
        });
    };
    // All passes, into black targets.
    const auto pictures = [&] {
        const RenderTarget first(device, size);
        const RenderTarget second(device, size);
        const std::vector<RenderView> views{{.camera = scene.camera, .target = first.target()},
                                            {.camera = scene.camera, .target = second.target()}};
        renderer.invalidate();
        renderer.render(scene.world, views);
        return std::pair(first.read(), second.read());
    };
    for (const ShadingPath path :
         {ShadingPath::deferred, ShadingPath::forward, ShadingPath::clustered_forward}) {
        CAPTURE(to_string(path));
        Configuration configuration = renderer.configuration();
        configuration.path = path;
        configuration.refinement.enabled = path == ShadingPath::deferred;  // one more pass with attachments
        configure(configuration);
        const auto usual = pictures();
        CHECK(mean(usual.first) > 0.01);
        CHECK(usual.second == usual.first);
        for (const ExtensionPlace place : {ExtensionPlace::after_surfaces, ExtensionPlace::after_shading,
                                           ExtensionPlace::before_tone_map}) {
            CAPTURE(static_cast<int>(place));
            careless.name = "careless";
            careless.place = place;
            REQUIRE(renderer.extend(careless).empty());
            const auto disturbed = pictures();
            CHECK(ran("careless"));
            CHECK(ran("careless 2"));
            CHECK(disturbed.first == usual.first);
            CHECK(disturbed.second == usual.second);
            renderer.remove_extension("careless");
        }
    }
}

TEST_CASE_FIXTURE(ExtensionTests,
                  "an extension that throws while it runs leaves the target, and can recover") {
    const Picture usual = frame();
    bool fails = true;
    const auto factor = [&](const WorldReader&) {
        if (fails) throw std::runtime_error("not now");
        return 1.0F;
    };
    REQUIRE(renderer.extend(scaling("moody", ExtensionPlace::before_tone_map, factor)).empty());
    const RenderTarget target(device, size);
    CHECK_THROWS_WITH(renderer.render(scene.world, scene.camera, target.target()), "not now");
    CHECK(mean(target.read()) == 0.0);
    fails = false;
    renderer.render(scene.world, scene.camera, target.target());
    CHECK(target.read() == usual);
}

TEST_CASE_FIXTURE(ExtensionTests, "verification finds an input that a pass of the host's does not declare") {
    float hidden = 1.0F;
    REQUIRE(
        renderer
            .extend(scaling("sly", ExtensionPlace::after_shading, [&](const WorldReader&) { return hidden; }))
            .empty());
    renderer.verify(true);
    static_cast<void>(frame());
    hidden = 2.0F;
    const RenderTarget target(device, size);
    std::string message;
    try {
        renderer.render(scene.world, scene.camera, target.target());
    } catch (const GraphError& error) {
        message = error.what();
    }
    CHECK(message.find("'sly'") != std::string::npos);
}

TEST_CASE_FIXTURE(ExtensionTests, "extensions that come and go leak nothing") {
    const auto come_and_go = [&] {
        REQUIRE(renderer.extend(scaling("gain", ExtensionPlace::before_tone_map, gain_of)).empty());
        static_cast<void>(frame());
        renderer.remove_extension("gain");
        static_cast<void>(frame());
    };
    // What was used remains in the pool of the graph, and passes draw to either of its textures in turn.
    for (int i = 0; i < 4; ++i) {
        come_and_go();
    }
    const gl::ObjectCounts before = device_of(renderer).live();
    for (int i = 0; i < 20; ++i) {
        come_and_go();
    }
    const gl::ObjectCounts after = device_of(renderer).live();
    // Queries of times that have not arrived yet come in addition.
    for (const gl::ObjectKind kind :
         {gl::ObjectKind::buffer, gl::ObjectKind::texture, gl::ObjectKind::framebuffer,
          gl::ObjectKind::vertex_array, gl::ObjectKind::sampler, gl::ObjectKind::program}) {
        CAPTURE(kind);
        CHECK(after[kind] == before[kind]);
    }
}

}  // TEST_SUITE("extensions")
