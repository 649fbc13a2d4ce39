#include <doctest/doctest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>
#include <string>
#include <vector>

#include "renderer/gl/compiling_program.hpp"
#include "renderer/gl/texture.hpp"
#include "tests/renderer/context_fixture.hpp"

using namespace candela;
using namespace candela::gl;

namespace {

std::string text_of(const std::vector<EmbeddedShader>& files, std::string_view name,
                    const std::vector<Define>& defines = {}) {
    return assemble(ShaderLibrary{files}, name, defines).text;
}

/// The error when assembling a stage.
std::string error_of(const std::vector<EmbeddedShader>& files, std::string_view name) {
    try {
        static_cast<void>(text_of(files, name));
    } catch (const ProgramError& error) {
        return error.what();
    }
    return {};
}

/// The error when making a program.
std::string error_of(Device& device, const std::vector<EmbeddedShader>& files,
                     const std::vector<std::string>& stages) {
    try {
        static_cast<void>(compile(device, ShaderLibrary{files}, stages));
    } catch (const ProgramError& error) {
        return error.what();
    }
    return {};
}

}  // namespace

TEST_SUITE("gl shader source") {
TEST_CASE("a stage starts with its version and defines") {
    CHECK(text_of({{"a.vert", "void main() {}"}}, "a.vert", {{"TILE", "16"}, {"FAST"}}) ==
          "#version 450 core\n#define TILE 16\n#define FAST 1\n#line 1 0\nvoid main() {}\n");
}

TEST_CASE("each included file is inserted once, and lines keep their numbers") {
    const std::vector<EmbeddedShader> files = {
        {"a.frag", "first\n#include \"b.glsl\"\n  #  include \"c.glsl\"\r\nlast\n"},
        {"b.glsl", "b1\n#include \"c.glsl\"\nb3\n"},
        {"c.glsl", "c1\n"},
    };
    const ShaderSource source = assemble(ShaderLibrary{files}, "a.frag");
    CHECK(source.text ==
          "#version 450 core\n"
          "#line 1 0\nfirst\n"
          "#line 1 1\nb1\n"
          "#line 1 2\nc1\n"
          "#line 3 1\nb3\n"
          "#line 3 0\n"
          "#line 4 0\nlast\n");
    CHECK(source.files == std::vector<std::string>{"a.frag", "b.glsl", "c.glsl"});
}

TEST_CASE("text that only looks like an include is not changed") {
    const std::string_view text = "// #include \"b.glsl\"\n#include_next\n";
    CHECK(text_of({{"a.frag", text}}, "a.frag") == "#version 450 core\n#line 1 0\n" + std::string(text));
}

TEST_CASE("errors name invalid includes by file and line") {
    CHECK(error_of({}, "a.frag") == "shaders/a.frag: there is no such shader file");
    CHECK(error_of({{"a.frag", "\n#include \"b.glsl\"\n"}, {"b.glsl", "\n\n#include \"c.glsl\"\n"}},
                   "a.frag") == "shaders/b.glsl:3: there is no shader file \"c.glsl\" to include");
    CHECK(error_of({{"a.frag", "#include \"a.frag\"\n"}}, "a.frag") ==
          "shaders/a.frag:1: \"a.frag\" includes itself: a.frag -> a.frag");
    CHECK(error_of({{"a.frag", "#include \"b.glsl\"\n"},
                    {"b.glsl", "\n#include \"c.glsl\"\n"},
                    {"c.glsl", "#include \"b.glsl\"\n"}},
                   "a.frag") ==
          "shaders/c.glsl:1: \"b.glsl\" includes itself: a.frag -> b.glsl -> c.glsl -> b.glsl");
}

TEST_CASE("in messages of drivers, file numbers are replaced by names") {
    const std::vector<std::string> files = {"a.frag", "shading/lighting.glsl"};
    CHECK(map_log("1:42(10): error: no such thing\n", files) ==
          "shaders/shading/lighting.glsl:42: error: no such thing\n");
    CHECK(map_log("0(7) : error C1008: undefined variable \"x\"\n1(9) : warning C7050: unset", files) ==
          "shaders/a.frag:7: error C1008: undefined variable \"x\"\n"
          "shaders/shading/lighting.glsl:9: warning C7050: unset\n");
    CHECK(map_log("2:1(1): of no file\nsome words\n", files) == "2:1(1): of no file\nsome words\n");
}

TEST_CASE("a directory can be a shader library, and is read again at each load") {
    const auto directory = std::filesystem::temp_directory_path() / "candela-shader-library-test";
    std::filesystem::create_directories(directory);
    const ShaderLibrary library(directory);
    for (const std::string text : {"one", "two\n"}) {
        std::ofstream(directory / "a.glsl") << text;
        CHECK(library.contains("a.glsl"));
        CHECK(library.load("a.glsl") == text);
    }
    std::filesystem::remove_all(directory);
    CHECK_FALSE(library.contains("a.glsl"));
    CHECK_THROWS_AS(static_cast<void>(library.load("a.glsl")), ProgramError);
}

}  // TEST_SUITE("gl shader source")

TEST_SUITE("gl program") {
TEST_CASE_FIXTURE(GlFixture, "an error in an included file is reported by file and line") {
    const std::vector<EmbeddedShader> files = {
        {"a.frag", "#include \"good.glsl\"\n#include \"bad.glsl\"\nout vec4 c;\nvoid main() { c = f(); }\n"},
        {"good.glsl", "float g() { return 1.0; }\n"},
        {"bad.glsl", "// fine\n\nvec4 f() {\n    return vec4(nothing);\n}\n"},
    };
    const std::string error = error_of(device, files, {"a.frag"});
    CHECK(error.starts_with("shaders/a.frag does not compile:\n"));
    CHECK(error.find("\nshaders/bad.glsl:4: ") != std::string::npos);
    CHECK(error.find("nothing") != std::string::npos);
}

TEST_CASE_FIXTURE(GlFixture, "the line of an error after an include is correct, too") {
    const std::vector<EmbeddedShader> files = {
        {"a.comp", "layout(local_size_x = 1) in;\n#include \"b.glsl\"\n\nvoid main() { nothing(); }\n"},
        {"b.glsl", "const int b = 1;\n\n\n\n"},
    };
    CHECK(error_of(device, files, {"a.comp"}).find("\nshaders/a.comp:4: ") != std::string::npos);
}

TEST_CASE_FIXTURE(GlFixture, "stages that do not link, or are unknown, are refused by name") {
    const std::vector<EmbeddedShader> files = {
        {"a.vert", "out vec3 x;\nvoid main() { x = vec3(1); gl_Position = vec4(0); }\n"},
        {"a.frag", "in vec4 x;\nout vec4 c;\nvoid main() { c = x; }\n"},
    };
    CHECK(error_of(device, files, {"a.vert", "a.frag"}).starts_with("a.vert and a.frag do not link: "));
    CHECK(error_of(device, files, {"a.glsl"}) ==
          "shaders/a.glsl: a stage file ends in .vert, .frag, .geom or .comp");
    CHECK(device.live() == ObjectCounts{});
}

TEST_CASE_FIXTURE(GlFixture, "defines choose a variant, and uniforms of every type can be set") {
    const std::vector<EmbeddedShader> files = {{"sum.comp", R"(
layout(local_size_x = 1) in;
layout(std430, binding = 0) buffer Results { float results[]; };
uniform bool flag; uniform int i; uniform uint u; uniform float f;
uniform vec2 v2; uniform vec3 v3; uniform vec4 v4; uniform uvec2 u2;
uniform mat3 m3; uniform mat4 m4; uniform vec4 v4s[2];
uniform float unused;
void main() {
    int n = 0;
    results[n++] = flag ? 1.0 : 0.0; results[n++] = float(i); results[n++] = float(u); results[n++] = f;
    results[n++] = v2.y; results[n++] = v3.z; results[n++] = v4.w; results[n++] = float(u2.y);
    results[n++] = m3[2].x; results[n++] = m4[3].x; results[n++] = v4s[1].y;
    results[n++] = float(VARIANT);
}
)"}};
    const Program program = compile(device, ShaderLibrary{files}, {"sum.comp"}, {{"VARIANT", "12"}});
    const Buffer results(device, "results", 12 * sizeof(float));
    results.bind_base(GL_SHADER_STORAGE_BUFFER, 0);
    program.use({{"flag", true},
                 {"i", -2},
                 {"u", 3U},
                 {"f", 4.0F},
                 {"v2", glm::vec2(0, 5)},
                 {"v3", glm::vec3(0, 0, 6)},
                 {"v4", glm::vec4(0, 0, 0, 7)},
                 {"u2", glm::uvec2(0, 8)},
                 {"m3", glm::mat3(glm::vec3(0), glm::vec3(0), glm::vec3(9, 0, 0))},
                 {"m4", glm::translate(glm::mat4(1), glm::vec3(10, 0, 0))},
                 {"v4s", std::vector{glm::vec4(0), glm::vec4(0, 11, 0, 0)}},
                 {"unused", 1.0F}});
    device.gl().DispatchCompute(1, 1, 1);
    CHECK(results.download<float>() == std::vector<float>{1, -2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12});
}

TEST_CASE_FIXTURE(GlFixture, "a program is used with each of its active uniforms, once and of its type") {
    const std::vector<EmbeddedShader> files = {{"a.comp", R"(
layout(local_size_x = 1) in;
layout(std430, binding = 0) buffer Results { float results[]; };
layout(binding = 0) uniform sampler2D picture;
uniform float x;
uniform uint y;
#ifdef SKY
uniform vec3 sky;
#endif
void main() {
    results[0] = x + float(y) + texelFetch(picture, ivec2(0), 0).r;
#ifdef SKY
    results[0] += sky.z;
#endif
}
)"}};
    const Program program = compile(device, ShaderLibrary{files}, {"a.comp"});
    const auto error_with = [&](const Uniforms& uniforms) -> std::string {
        try {
            program.use(uniforms);
        } catch (const ProgramError& error) {
            return error.what();
        }
        return {};
    };
    CHECK(error_with({{"x", 1.0F}, {"y", 2U}}).empty());
    CHECK(error_with({{"x", 1.0F}, {"y", 2U}, {"sky", glm::vec3(0.0F)}}).empty());
    CHECK(error_with({{"x", 1.0F}}) == "a.comp: uniform 'y' is not set");
    CHECK(error_with({{"x", 1.0F}, {"y", 2}}) == "a.comp: uniform 'y' has another type");
    CHECK(error_with({{"x", 1.0F}, {"y", 2U}, {"x", 3.0F}}) == "a.comp: uniform 'x' is set twice");
    CHECK(error_with({{"x", 1.0F}, {"y", 2U}, {"z", 0.0F}}) == "a.comp: no uniform 'z'");
}

TEST_CASE_FIXTURE(GlFixture, "a triangle with float and integer vertex attributes is drawn") {
    const std::vector<EmbeddedShader> files = {
        {"flat.vert",
         "layout(location = 0) in vec2 position;\nlayout(location = 1) in uint red;\nflat out uint "
         "colour;\n"
         "void main() { colour = red; gl_Position = vec4(position, 0, 1); }\n"},
        {"flat.frag",
         "flat in uint colour;\nlayout(location = 0) out vec4 target;\n"
         "void main() { target = vec4(colour, gl_FragCoord.xy, 1); }\n"},
    };
    struct Corner {
        glm::vec2 position;
        std::uint32_t red;
    };
    // One triangle that covers the whole target.
    const std::array corners = {Corner{{-1, -1}, 5}, Corner{{3, -1}, 5}, Corner{{-1, 3}, 5}};
    const Buffer vertices(device, "vertices", corners);
    const Buffer indices(device, "indices", std::array<std::uint32_t, 3>{0, 1, 2});
    VertexArray array(device, "array");
    array.vertex_buffer(vertices.name(), sizeof(Corner));
    array.attribute(0, 2, GL_FLOAT, 0);
    array.integer_attribute(1, 1, GL_UNSIGNED_INT, sizeof(glm::vec2));
    array.index_buffer(indices.name());

    const Texture colour(device, "colour", {.size = {2, 2}, .format = Format::rgba32f});
    Framebuffer framebuffer(device, "target");
    framebuffer.attach_colour(0, colour.name());
    framebuffer.draw_buffers(1);
    const Program program = compile(device, ShaderLibrary{files}, {"flat.vert", "flat.frag"});

    framebuffer.bind();
    array.bind();
    program.use();
    device.gl().Viewport(0, 0, 2, 2);
    device.gl().DrawElements(GL_TRIANGLES, 3, GL_UNSIGNED_INT, nullptr);
    CHECK(colour.read_floats() ==
          std::vector<float>{5, 0.5, 0.5, 1, 5, 1.5, 0.5, 1, 5, 0.5, 1.5, 1, 5, 1.5, 1.5, 1});
}

}  // TEST_SUITE("gl program")
