// Every variant of every program must pass a second compiler, in addition to the driver's: glslang, the
// reference compiler.

#include <doctest/doctest.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <candela/extension.hpp>
#include <candela/graph/describe.hpp>
#include <candela/graph/frame_graph.hpp>
#include <candela/inspection.hpp>
#include <candela/scene/tangents.hpp>
#include "renderer/facade/device_of.hpp"
#include "renderer/gl/shader_source.hpp"
#include "shaders/bindings.glsl"
#include "tests/renderer/path_fixture.hpp"
#include "tests/renderer/recorded_programs.hpp"
#include "tests/renderer/shader_rules.hpp"
#include "tests/sandbox/temporary_folder.hpp"

TEST_SUITE("second compiler") {

using namespace candela;

namespace {

std::set<RecordedShader> sources;  // passed to the driver, or by a host

/// Storage blocks of all stages of a program.
std::uint32_t storage_blocks_of(const gl::Functions& gl, GLuint program) {
    GLint blocks = 0;
    gl.GetProgramInterfaceiv(program, GL_SHADER_STORAGE_BLOCK, GL_ACTIVE_RESOURCES, &blocks);
    return static_cast<std::uint32_t>(blocks);
}

/// Whether a shader with all these macros was passed to the driver.
bool has_variant(const std::vector<std::string>& macros) {
    return std::ranges::any_of(sources, [&](const auto& source) {
        return std::ranges::all_of(macros, [&](const std::string& macro) {
            return source.text.find("#define " + macro + " ") != std::string::npos;
        });
    });
}

/// A square without any texture.
MeshInstance plain_square(AlphaMode mode) {
    Material material;
    material.alpha_mode = mode;
    return {square(1.0F, std::make_shared<const Material>(material))};
}

constexpr std::array all_modes{AlphaMode::opaque, AlphaMode::mask, AlphaMode::blend};

/// A square with a normal texture.
MeshInstance bumpy_square(AlphaMode mode) {
    Material material;
    material.alpha_mode = mode;
    material.base_colour.a = 0.5F;
    material.normal_texture = std::make_shared<const Image>(
        Image{.width = 1, .height = 1, .texels = {{128, 128, 255, 255}}, .encoding = Encoding::linear});
    Mesh mesh = *square(1.0F, std::make_shared<const Material>(std::move(material)));
    derive_tangents(mesh.primitives[0]);
    return {std::make_shared<const Mesh>(std::move(mesh))};
}

/// A square of glass whose occlusion lies by second texture coordinates.
MeshInstance glass_square() {
    Material material;
    material.transmission = 0.5F;
    material.occlusion_texture = std::make_shared<const Image>(
        Image{.width = 1, .height = 1, .texels = {{128, 0, 0, 255}}, .encoding = Encoding::linear});
    material.second_uvs.occlusion = true;
    Mesh mesh = *square(1.0F, std::make_shared<const Material>(std::move(material)));
    mesh.primitives[0].second_uvs.resize(mesh.primitives[0].vertices.size());
    return {std::make_shared<const Mesh>(std::move(mesh))};
}

std::string text_of(const std::filesystem::path& file) {
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// The comment at the head of a shader file, by which it is recognised in a source.
std::string first_line(std::string_view text) {
    const std::size_t comment = text.find("// ");
    return std::string(text.substr(comment, text.find('\n', comment) - comment));
}

/// The macros that a shader file asks for.
std::set<std::string> macros_asked(std::string_view text, const char* form) {
    std::set<std::string> macros;
    const std::string file(text);
    const std::regex asked(form);
    for (std::sregex_iterator match(file.begin(), file.end(), asked), end; match != end; ++match) {
        macros.insert((*match)[1]);
    }
    return macros;
}

/// Notes a host's fragment shader with the functions that light points.
Extension lighting_points() {
    Extension extension{.name = "points", .place = ExtensionPlace::after_shading};
    extension.declare = [](FrameGraph&, ViewFrame& frame) {
        if (!frame.lighting) return;
        sources.insert(
            {.stage = GL_FRAGMENT_SHADER, .text = "#version 450 core\n" + frame.lighting->glsl() + R"(
layout(location = 0) out vec3 lit;
void main() { lit = candela_irradiance(vec3(0.0), vec3(0.0, 1.0, 0.0), 0u); })"});
    };
    return extension;
}

}  // namespace

TEST_CASE_FIXTURE(GlFixture, "glslang compiles every variant of every program") {
    TestedRenderer renderer(RecordedPrograms::recording(context->get_proc()));
    pretend(renderer, true);
    Configuration configuration;
    configuration.refinement.enabled = true;
    REQUIRE(renderer.extend(lighting_points()).empty());
    const auto configure_each = [&](VplPlacement placement, Show show) {
        configuration.vpls.placement = placement;
        configuration.show = show;
        for (const ShadingPath path : all_shading_paths) {
            for (const auto method : {VplVisibility::none, VplVisibility::maps, VplVisibility::rays}) {
                for (const Interleave interleave : {Interleave::one, Interleave::eight}) {
                    configuration.path = path;
                    configuration.visibility.method = method;
                    configuration.interleave = interleave;
                    // 16 are so few that the shading passes gather them themselves.
                    configuration.vpls.count = interleave == Interleave::one ? 16 : 256;
                    REQUIRE(renderer.configure(configuration).empty());
                }
            }
        }
    };
    // The renderer builds what the last world needs: here surfaces of all kinds.
    World world;
    const Entity camera = add(world, at({0.0F, 1.0F, 0.0F}), Camera{});
    for (const AlphaMode mode : all_modes) add(world, Transform{}, plain_square(mode));
    const RenderTarget target(device, {1, 1});
    renderer.render(world, camera, target.target());
    configure_each(VplPlacement::surfels, Show::total);
    configure_each(VplPlacement::paths, Show::total);
    configuration.tone_map.automatic_exposure = true;
    REQUIRE(renderer.configure(configuration).empty());
    for (const Show show : {Show::indirect, Show::irradiance, Show::albedo, Show::normals}) {
        configure_each(VplPlacement::surfels, show);
    }
    // And a sun, a sky and a surface that emits light.
    add(world, Transform{}, DirectionalLight{});
    add(world, Environment{.radiance = glm::vec3(1.0F), .picture = nullptr});
    add(world, Transform{}, MeshInstance{square(1.0F, emitter(glm::vec3(1.0F)))});
    renderer.set_receivers({{.position = {}, .normal = {0.0F, 1.0F, 0.0F}}});
    renderer.render(world, camera, target.target());
    configure_each(VplPlacement::surfels, Show::total);
    // Surfaces with normal textures, without glossy ones.
    for (const AlphaMode mode : all_modes) add(world, Transform{}, bumpy_square(mode));
    renderer.render(world, camera, target.target());
    configure_each(VplPlacement::surfels, Show::total);
    configure_each(VplPlacement::surfels, Show::normals);
    // And with one.
    Material metal;
    metal.metalness = 1.0F;
    add(world, Transform{}, MeshInstance{square(1.0F, std::make_shared<const Material>(metal))});
    renderer.render(world, camera, target.target());
    for (const Show show : {Show::roughness, Show::metalness, Show::total}) {
        configure_each(VplPlacement::surfels, show);
    }
    // And with all that images may lie by, and glass.
    add(world, Transform{}, glass_square());
    renderer.render(world, camera, target.target());
    configure_each(VplPlacement::surfels, Show::total);
    // And more surfaces than VPLs, of which some share one; more VPLs than are summed one by one, in a
    // picture that is enlarged, with an estimate of its error; on a driver without a CPU's limits.
    for (int i = 0; i < 300; ++i)
        add(world, at({0.0F, -0.01F * static_cast<float>(i), 0.0F}), plain_square(AlphaMode::opaque));
    const RenderTarget large(device, {64, 48});
    configuration.frame_budget_ms = 1e-3F;
    const auto render_with = [&](std::uint32_t vpls) {
        configuration.vpls.count = vpls;
        REQUIRE(renderer.configure(configuration).empty());
        for (int frame = 0; frame < 3; ++frame) {
            world.set(camera, at({0.0F, 1.0F + 0.01F * static_cast<float>(frame), 0.0F}));
            const RenderView view{.camera = camera, .target = large.target(), .estimate_error = true};
            renderer.render(world, {&view, 1});
        }
    };
    render_with(16);
    render_with(1024);
    pretend(renderer, false);
    const ShadingPath with_clusters = std::exchange(configuration.path, ShadingPath::tiled_deferred);
    render_with(256);
    configuration.path = with_clusters;
    render_with(256);
    // And from surfaces of a host's.
    const gl::Texture depth(device, "depth", {{1, 1}, Format::r32f});
    const gl::Texture normal(device, "normal", {{1, 1}, Format::rgba32f});
    const RenderView of_host{
        .camera = camera,
        .target = target.target(),
        .surfaces = HostSurfaces{.depth = depth.name(), .normal = normal.name(), .albedo = normal.name()}};
    renderer.render(world, {&of_host, 1});
    // Inspection of textures, of integers and of light lists, and the difference of two pictures.
    Extension integers{.name = "integers", .place = ExtensionPlace::after_surfaces};
    integers.declare = [](FrameGraph& graph, ViewFrame&) {
        graph.add("integers", [&](Pass& pass) {
            static_cast<void>(pass.write(graph.texture("integers", {{1, 1}, Format::r32ui}), Usage::copy));
        });
    };
    REQUIRE(renderer.extend(integers).empty());
    ResourceInspector inspector(renderer);
    for (const char* const name : {"albedo", "integers", "light-clusters count"}) {
        REQUIRE(inspector.show(Inspection{.resource = name}).empty());
        CHECK(describe_text(renderer.description()).find(name) != std::string::npos);
    }
    const gl::Texture picture(device, "picture", {{1, 1}, Format::rgba8});
    draw_difference(renderer, picture.name(), picture.name(), 1.0F, target.target());
    std::vector<RecordedProgram> programs = RecordedPrograms::take();
    for (RecordedProgram& program : programs) {
        for (RecordedShader& shader : program.shaders) sources.insert(std::move(shader));
    }
    // Every stage was there, and every macro that a file asks for and none defines.
    std::set<std::string> asked;
    std::set<std::string> defined;
    for (const gl::EmbeddedShader& file : gl::embedded_shaders()) {
        if (!file.name.ends_with(".glsl")) {
            const std::string head = first_line(file.text);
            const bool there = std::ranges::any_of(
                sources, [&](const auto& source) { return source.text.find(head) != std::string::npos; });
            CHECK_MESSAGE(there, file.name);
        }
        asked.merge(macros_asked(file.text, R"(#ifn?def (\w+))"));
        asked.merge(macros_asked(file.text, R"(defined\((\w+)\))"));
        defined.merge(macros_asked(file.text, R"(#define (\w+))"));
    }
    for (const std::string& macro : asked) {
        if (macro != "__cplusplus" && !defined.contains(macro)) CHECK_MESSAGE(has_variant({macro}), macro);
    }
    for (const auto& variant : std::vector<std::vector<std::string>>{{"AUTOMATIC"},
                                                                     {"BUMPY"},
                                                                     {"BUMPY", "MASKED"},
                                                                     {"BUMPY", "GLOSSY"},
                                                                     {"BUMPY", "DIRECTED"},
                                                                     {"DIRECTED", "GLOSSY"},
                                                                     {"MIRRORED"},
                                                                     {"EMITTERS", "EMISSION", "SKY"},
                                                                     {"EMITTERS", "BUMPY"},
                                                                     {"SECOND_UV", "GLOSSY"},
                                                                     {"SECOND_UV", "GLASS"}}) {
        CAPTURE(variant.front());
        CAPTURE(variant.back());
        CHECK(has_variant(variant));
    }

    // A driver that offers fewer storage blocks than the largest program needs is refused at once.
    std::uint32_t most = 0;
    for (const RecordedProgram& program : programs) {
        most = std::max(most, storage_blocks_of(device.gl(), program.name));
    }
    CHECK(most == MOST_STORAGE_BLOCKS);

    if (std::system("command -v glslangValidator > /dev/null") != 0) {
        MESSAGE("skipped: no glslangValidator, see glslang-tools in .ci/packages");
        return;
    }
    const sandbox::TemporaryFolder folder;
    std::string command = "glslangValidator";
    int number = 0;
    for (const auto& [stage, text] : sources) {
        const std::string name = std::to_string(number++) + "." + file_ending(stage);
        std::ofstream(folder / name.c_str()) << text;
        command += " " + (folder / name.c_str()).string();
    }
    command += " > " + (folder / "said").string();
    const int status = std::system(command.c_str());
    CHECK_MESSAGE(WEXITSTATUS(status) == 0, text_of(folder / "said"));

    // What the preprocessor leaves of each means the same to every driver.
    const std::string preprocess =
        "cd " + (folder / "").string() + " && glslangValidator -E *.frag *.comp > preprocessed";
    REQUIRE(std::system(preprocess.c_str()) == 0);
    const std::string all = text_of(folder / "preprocessed");
    std::set<std::string> faults;
    std::size_t shaders = 0;
    for (std::size_t at = all.find("#version"); at < all.size(); ++shaders) {
        const std::size_t end = std::min(all.find("#version", at + 1), all.size());
        for (const std::string& fault : ambiguities(all.substr(at, end - at))) faults.insert(fault);
        at = end;
    }
    CHECK(shaders == static_cast<std::size_t>(std::ranges::count_if(sources, [](const auto& source) {
              return source.stage == GL_FRAGMENT_SHADER || source.stage == GL_COMPUTE_SHADER;
          })));
    for (const std::string& fault : faults) FAIL_CHECK(fault);
}

}  // TEST_SUITE("second compiler")
