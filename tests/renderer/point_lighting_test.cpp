// Light at any point, in shaders of a host's passes.

#include <doctest/doctest.h>

#include <glm/geometric.hpp>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <candela/extension.hpp>
#include <candela/graph/execute.hpp>
#include "renderer/gl/compiling_program.hpp"
#include "renderer/gl/texture.hpp"
#include "tests/renderer/path_fixture.hpp"

TEST_SUITE("light at points") {

using namespace candela;

namespace {

constexpr std::uint32_t point_count = 40;
constexpr glm::vec3 up{0.0F, 1.0F, 0.0F};

/// Points along a line, above the middle of the Cornell box and of the ground.
glm::vec3 point(std::uint32_t i) {
    return {-0.8F + 0.04F * static_cast<float>(i), 0.9F, 0.1F};
}

constexpr std::string_view whole_viewport = R"(
void main() {
    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
})";

/// A texel per point, with the value of a GLSL expression of `position`, `up` and the point's `number`.
std::string fragment(const std::string& lighting, const std::string& expression) {
    return lighting + R"(
layout(location = 0) out vec4 result;
void main() {
    const vec3 up = vec3(0.0, 1.0, 0.0);
    uint number = uint(gl_FragCoord.x);
    vec3 position = vec3(-0.8 + 0.04 * float(number), 0.9, 0.1);
    result = vec4()" +
           expression + ", 1.0);\n}\n";
}

class PointLightingTests : public RenderFixture {
 protected:
    /// Adds a pass that evaluates the expression at all points of each frame.
    void evaluate(const std::string& expression) {
        Extension extension{.name = "points", .place = ExtensionPlace::after_shading};
        extension.declare = [=, this](FrameGraph& graph, ViewFrame& frame) {
            shows_light = frame.lighting.has_value();
            if (shows_light) add_passes(graph, *frame.lighting, expression);
        };
        REQUIRE(renderer.extend(extension).empty());
    }

    /// The values in the next frame.
    std::vector<glm::vec3> values(const Scene& scene) {
        (void)render(scene, {16, 16});
        return found;
    }

    std::vector<glm::vec3> found;
    bool shows_light = false;

 private:
    void add_passes(FrameGraph& graph, const PointLighting& lighting, const std::string& expression) {
        const std::string source = fragment(lighting.glsl(), expression);
        const std::vector<gl::EmbeddedShader> files{{"all.vert", whole_viewport}, {"points.frag", source}};
        const auto program = std::make_shared<gl::Program>(
            gl::compile(device, gl::ShaderLibrary{files}, {"all.vert", "points.frag"}));
        const auto vertices = std::make_shared<gl::VertexArray>(device, "host's");
        const TextureHandle lit = graph.add("light points", [&](Pass& pass) {
            lighting.read(pass);
            pass.parameter(source);
            const TextureHandle out = pass.write(graph.texture("points", {{point_count, 1}, Format::rgba32f}),
                                                 Usage::colour_target);
            pass.run([=, this](Execution&) {
                program->use();
                vertices->bind();
                device.gl().DrawArrays(GL_TRIANGLES, 0, 3);
            });
            return out;
        });
        graph.add("read points", [&](Pass& pass) {
            pass.side_effect();
            pass.read(lit, Usage::copy);
            pass.run([=, this](Execution& run) {
                found.clear();
                for (const glm::vec4& texel :
                     gl::read_texels(device.gl(), run.object(lit), {point_count, 1})) {
                    found.emplace_back(texel);
                }
            });
        });
    }
};

std::vector<Receiver> receivers_at_points() {
    std::vector<Receiver> receivers;
    for (std::uint32_t i = 0; i < point_count; ++i) receivers.push_back({point(i), up});
    return receivers;
}

double worst_difference(const std::vector<glm::vec3>& found, const std::vector<glm::vec3>& expected) {
    REQUIRE(found.size() == expected.size());
    return worst_error({{found.size(), 1}, found}, {{expected.size(), 1}, expected}, 1e-6);
}

const std::string from_all_vpls = "candela_irradiance_from_vpls(position, up, candela_vpl_count(), 0u)";

}  // namespace

TEST_CASE_FIXTURE(PointLightingTests, "shaders of the host's find what its receivers get") {
    Scene scene = cornell_box();
    add(scene.world, at({0.3F, 1.2F, 0.2F}), MeshInstance{square(0.1F, emitter(glm::vec3(5.0F)))});
    add(scene.world, Environment{.radiance = {0.1F, 0.2F, 0.4F}, .picture = nullptr});
    renderer.set_receivers(receivers_at_points());
    evaluate("candela_irradiance_from_lights(position, up) + " + from_all_vpls);
    for (const VplPlacement placement : {VplPlacement::surfels, VplPlacement::paths}) {
        for (const VplVisibility method : {VplVisibility::none, VplVisibility::rays, VplVisibility::maps}) {
            for (const bool shadows : {false, true}) {
                CAPTURE(static_cast<int>(placement));
                CAPTURE(static_cast<int>(method));
                CAPTURE(shadows);
                Configuration configuration = linear_configuration();
                configuration.vpls.count = 32;
                configuration.vpls.placement = placement;
                configuration.visibility.method = method;
                configuration.shadows.enabled = shadows;
                configure(configuration);
                const std::vector<glm::vec3> here = values(scene);
                CHECK(glm::length(here.front()) > 0.1F);
                // Some hundred terms, in another order of rounding.
                CHECK(worst_difference(here, renderer.received_light()) < 1e-5);
            }
        }
    }
    SUBCASE("of what is shown") {
        for (const Show show : {Show::direct, Show::indirect, Show::irradiance}) {
            Configuration configuration = linear_configuration();
            configuration.vpls.count = 32;
            configuration.show = show;
            configure(configuration);
            const std::vector<glm::vec3> here = values(scene);
            CHECK(worst_difference(here, renderer.received_light()) < 1e-5);
        }
    }
    SUBCASE("and nothing where no light is shown") {
        Configuration configuration = linear_configuration();
        configuration.show = Show::albedo;
        configure(configuration);
        (void)values(scene);
        CHECK_FALSE(shows_light);
    }
}

TEST_CASE_FIXTURE(PointLightingTests, "the patterns of VPLs share all of them") {
    const Scene scene = cornell_box();
    Configuration configuration = linear_configuration();
    configuration.vpls.count = 64;
    configuration.visibility.method = VplVisibility::rays;
    configure(configuration);
    evaluate(from_all_vpls);
    const std::vector<glm::vec3> whole = values(scene);
    evaluate(R"((candela_irradiance_from_vpls(position, up, (candela_vpl_count() + 2u) / 3u, 0u) +
                 candela_irradiance_from_vpls(position, up, (candela_vpl_count() + 2u) / 3u, 1u) +
                 candela_irradiance_from_vpls(position, up, (candela_vpl_count() + 2u) / 3u, 2u)) / 3.0)");
    CHECK(worst_difference(values(scene), whole) < 1e-5);  // roundings of a sum of 64
}

TEST_CASE_FIXTURE(PointLightingTests,
                  "in the air, a lamp gives I / r² from its side, and none through a wall") {
    Scene scene = ground();
    constexpr glm::vec3 from{0.4F, 0.2F, -0.2F};  // below most points, so that no surface there would face it
    scene.world.set(scene.light, at(from));
    scene.world.set(scene.light, PointLight{.intensity = 7.0F});
    Configuration configuration = linear_configuration();
    configuration.indirect = false;
    configure(configuration);
    evaluate("float(candela_light_count()) * candela_light(0u, position).irradiance");
    std::vector<glm::vec3> expected;
    for (std::uint32_t i = 0; i < point_count; ++i) {
        const glm::vec3 apart = from - point(i);
        expected.emplace_back(7.0F / glm::dot(apart, apart));
    }
    CHECK(worst_difference(values(scene), expected) < 1e-5);  // some ten roundings of floats
    evaluate("candela_light(0u, position).direction");
    for (std::uint32_t i = 0; i < point_count; ++i) {
        CHECK(glm::distance(values(scene)[i], glm::normalize(from - point(i))) < 1e-5F);
    }
    evaluate("candela_light(0u, position, up).irradiance + candela_irradiance_from_lights(position, up)");
    CHECK(values(scene) == std::vector<glm::vec3>(point_count));  // what faces up gets none from below
    add(scene.world, at({0.0F, 0.5F, 0.0F}), MeshInstance{square(3.0F, diffuse(glm::vec3(0.5F)))});
    evaluate("candela_light(0u, position).irradiance");
    CHECK(values(scene) == std::vector<glm::vec3>(point_count));
}

TEST_CASE_FIXTURE(PointLightingTests, "a uniform sky gives π L, also in a world without surfaces") {
    Scene scene;
    scene.camera = add(scene.world, looking({0, 1, 3}, {0, 1, 0}), Camera{});
    const Environment sky{.radiance = {0.5F, 1.0F, 2.0F}, .picture = nullptr};
    add(scene.world, sky);
    configure(linear_configuration());
    evaluate(from_all_vpls);
    const std::vector<glm::vec3> expected(point_count, std::numbers::pi_v<float> * sky.radiance);
    // The sky is a few hundred patches, each above the horizon or below it as a whole: some percent.
    CHECK(worst_difference(values(scene), expected) < 0.05);
}

TEST_CASE_FIXTURE(PointLightingTests, "they are evaluated again when the light changes, and only then") {
    Scene scene = cornell_box();
    configure(linear_configuration());
    evaluate("candela_irradiance(position, up, number)");
    const std::vector<glm::vec3> before = values(scene);
    CHECK(ran("light points"));
    CHECK(values(scene) == before);
    CHECK_FALSE(ran("light points"));
    add(scene.world, at({0.1F, 1.5F, 0.1F}), PointLight{.intensity = 5.0F});
    CHECK(values(scene) != before);
    CHECK(ran("light points"));
}

TEST_CASE_FIXTURE(PointLightingTests, "the functions can be a shader object of their own") {
    const Scene scene = cornell_box();
    configure(linear_configuration());
    std::string functions;
    Extension extension{.name = "text", .place = ExtensionPlace::after_shading};
    extension.declare = [&](FrameGraph&, ViewFrame& frame) { functions = frame.lighting->glsl(); };
    REQUIRE(renderer.extend(extension).empty());
    (void)render(scene, {16, 16});
    renderer.remove_extension("text");
    // The host's own Surface is another one.
    const std::string host = R"(
struct Surface { float own; };
vec3 candela_irradiance(vec3 position, vec3 normal, uint pattern);
layout(location = 0) out vec4 result;
void main() {
    Surface surface = Surface(1.0);
    result = vec4(candela_irradiance(vec3(surface.own), vec3(0.0, 1.0, 0.0), 0u), 1.0);
})";
    const gl::Functions& gl = device.gl();
    const GLuint program = gl.CreateProgram();
    for (const std::string& part : {functions, host}) {
        const GLuint shader = gl.CreateShader(GL_FRAGMENT_SHADER);
        const std::string source = "#version 450 core\n" + part;
        const char* const text = source.c_str();
        gl.ShaderSource(shader, 1, &text, nullptr);
        gl.CompileShader(shader);
        gl.AttachShader(program, shader);
        gl.DeleteShader(shader);
    }
    gl.LinkProgram(program);
    GLint linked = GL_FALSE;
    gl.GetProgramiv(program, GL_LINK_STATUS, &linked);
    std::string log(1000, ' ');
    gl.GetProgramInfoLog(program, static_cast<GLsizei>(log.size()), nullptr, log.data());
    CAPTURE(log.c_str());
    CHECK(linked == GL_TRUE);
    gl.DeleteProgram(program);
}

}  // TEST_SUITE("light at points")
