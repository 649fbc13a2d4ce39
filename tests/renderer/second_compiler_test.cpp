// Every variant of every program must pass a second compiler, in addition to the driver's: glslang, the
// reference compiler.

#include <doctest/doctest.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <candela/extension.hpp>
#include <candela/graph/frame_graph.hpp>
#include <candela/inspection.hpp>
#include <candela/scene/tangents.hpp>
#include "shaders/bindings.glsl"
#include "tests/renderer/path_fixture.hpp"
#include "tests/sandbox/temporary_folder.hpp"

TEST_SUITE("second compiler") {

using namespace candela;

namespace {

std::map<GLuint, GLenum> stage_of_shader;
std::set<std::pair<GLenum, std::string>> sources;  // passed to the driver

PFNGLCREATESHADERPROC create_shader = nullptr;
PFNGLSHADERSOURCEPROC shader_source = nullptr;
PFNGLLINKPROGRAMPROC link_program = nullptr;
std::vector<GLuint> programs;  // linked by the driver

GLuint note_stage(GLenum stage) {
    const GLuint shader = create_shader(stage);
    stage_of_shader[shader] = stage;
    return shader;
}

void note_source(GLuint shader, GLsizei count, const GLchar* const* texts, const GLint* lengths) {
    std::string whole;
    for (GLsizei i = 0; i < count; ++i) whole.append(texts[i], static_cast<std::size_t>(lengths[i]));
    sources.emplace(stage_of_shader.at(shader), std::move(whole));
    shader_source(shader, count, texts, lengths);
}

void note_program(GLuint program) {
    link_program(program);
    programs.push_back(program);
}

/// Storage blocks of all stages of a program.
std::uint32_t storage_blocks_of(const gl::Functions& gl, GLuint program) {
    GLint blocks = 0;
    gl.GetProgramInterfaceiv(program, GL_SHADER_STORAGE_BLOCK, GL_ACTIVE_RESOURCES, &blocks);
    return static_cast<std::uint32_t>(blocks);
}

/// The driver's functions; those that take shaders or link programs record their arguments.
gl::GetProc noting(const gl::GetProc& get_proc) {
    return [get_proc](const char* name) -> void (*)() {
        void (*const found)() = get_proc(name);
        if (std::string(name) == "glCreateShader") {
            create_shader = reinterpret_cast<PFNGLCREATESHADERPROC>(found);
            return reinterpret_cast<void (*)()>(&note_stage);
        }
        if (std::string(name) == "glShaderSource") {
            shader_source = reinterpret_cast<PFNGLSHADERSOURCEPROC>(found);
            return reinterpret_cast<void (*)()>(&note_source);
        }
        if (std::string(name) == "glLinkProgram") {
            link_program = reinterpret_cast<PFNGLLINKPROGRAMPROC>(found);
            return reinterpret_cast<void (*)()>(&note_program);
        }
        return found;
    };
}

/// Whether a shader with all these macros was passed to the driver.
bool has_variant(const std::vector<std::string>& macros) {
    return std::ranges::any_of(sources, [&](const auto& source) {
        return std::ranges::all_of(macros, [&](const std::string& macro) {
            return source.second.find("#define " + macro + " ") != std::string::npos;
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

/// The file extension by which glslang recognises the stage.
std::string ending(GLenum stage) {
    switch (stage) {
        case GL_VERTEX_SHADER:
            return "vert";
        case GL_GEOMETRY_SHADER:
            return "geom";
        case GL_FRAGMENT_SHADER:
            return "frag";
        default:
            return "comp";
    }
}

/// Notes a host's fragment shader with the functions that light points.
Extension lighting_points() {
    Extension extension{.name = "points", .place = ExtensionPlace::after_shading};
    extension.declare = [](FrameGraph&, ViewFrame& frame) {
        if (!frame.lighting) return;
        sources.emplace(GL_FRAGMENT_SHADER, "#version 450 core\n" + frame.lighting->glsl() + R"(
layout(location = 0) out vec3 lit;
void main() { lit = candela_irradiance(vec3(0.0), vec3(0.0, 1.0, 0.0), 0u); })");
    };
    return extension;
}

}  // namespace

TEST_CASE_FIXTURE(GlFixture, "glslang compiles every variant of every program") {
    TestedRenderer renderer(noting(context->get_proc()));
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
        CHECK(renderer.describe(GraphFormat::text).find(name) != std::string::npos);
    }
    const gl::Texture picture(device, "picture", {{1, 1}, Format::rgba8});
    draw_difference(renderer, picture.name(), picture.name(), 1.0F, target.target());
    CHECK(sources.size() > 40);
    for (const auto& variant : std::vector<std::vector<std::string>>{{"AUTOMATIC"},
                                                                     {"BUMPY"},
                                                                     {"BUMPY", "MASKED"},
                                                                     {"BUMPY", "GLOSSY"},
                                                                     {"BUMPY", "DIRECTED"},
                                                                     {"DIRECTED", "COLUMNS"},
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
    for (const GLuint program : programs) most = std::max(most, storage_blocks_of(device.gl(), program));
    CHECK(most == MOST_STORAGE_BLOCKS);

    const sandbox::TemporaryFolder folder;
    std::string command = CANDELA_GLSLANG;
    int number = 0;
    for (const auto& [stage, text] : sources) {
        const std::string name = std::to_string(number++) + "." + ending(stage);
        std::ofstream(folder / name.c_str()) << text;
        command += " " + (folder / name.c_str()).string();
    }
    command += " > " + (folder / "said").string();
    const int status = std::system(command.c_str());
    std::ifstream said(folder / "said");
    const std::string log{std::istreambuf_iterator<char>(said), {}};
    CHECK_MESSAGE(WEXITSTATUS(status) == 0, log);
}

}  // TEST_SUITE("second compiler")
