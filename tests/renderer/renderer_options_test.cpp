#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/facade/device_of.hpp"
#include "sandbox/files/shipped_file.hpp"
#include "tests/renderer/scene_builder.hpp"
#include "tests/throws.hpp"

TEST_SUITE("renderer options") {

using namespace candela;

namespace {

constexpr glm::uvec2 size{16, 12};

using Proc = void (*)();

/// A debug callback of the host.
struct HostCallback {
    mutable int messages = 0;
    static void APIENTRY receive(GLenum, GLenum, GLuint, GLenum, GLsizei, const GLchar*, const void* user) {
        ++static_cast<const HostCallback*>(user)->messages;
    }
};

/// What the host can see of the debug state.
struct DebugState {
    void* callback = nullptr;
    void* user = nullptr;
    bool enabled = false;
    bool synchronous = false;
    bool operator==(const DebugState&) const = default;
};

DebugState debug_state(const gl::Functions& gl) {
    DebugState state;
    gl.GetPointerv(GL_DEBUG_CALLBACK_FUNCTION, &state.callback);
    gl.GetPointerv(GL_DEBUG_CALLBACK_USER_PARAM, &state.user);
    state.enabled = gl.IsEnabled(GL_DEBUG_OUTPUT) == GL_TRUE;
    state.synchronous = gl.IsEnabled(GL_DEBUG_OUTPUT_SYNCHRONOUS) == GL_TRUE;
    return state;
}

PFNGLGETINTEGERVPROC get_integer = nullptr;

/// A driver with the fewest storage blocks that OpenGL 4.5 allows.
void APIENTRY get_few(GLenum what, GLint* value) {
    get_integer(what, value);
    if (what == GL_MAX_COMBINED_SHADER_STORAGE_BLOCKS) *value = 8;
}

gl::GetProc with_few_blocks(const gl::GetProc& proc) {
    get_integer = reinterpret_cast<PFNGLGETINTEGERVPROC>(proc("glGetIntegerv"));
    return [proc](const char* name) {
        return std::strcmp(name, "glGetIntegerv") == 0 ? reinterpret_cast<Proc>(&get_few) : proc(name);
    };
}

}  // namespace

TEST_CASE("without debug output, the debug state of the context stays as it is") {
    const auto context = make_current_context();
    const gl::Functions gl = gl::load_functions(context->get_proc());
    const Scene scene = cornell_box();
    HostCallback host;
    for (const bool enabled : {false, true}) {
        gl.DebugMessageCallback(&HostCallback::receive, &host);
        (enabled ? gl.Enable : gl.Disable)(GL_DEBUG_OUTPUT);
        gl.Disable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
        const DebugState before = debug_state(gl);
        {
            Renderer renderer(context->get_proc());
            CHECK(debug_state(gl) == before);
            REQUIRE(renderer.configure(linear_configuration()).empty());
            const RenderTarget target(device_of(renderer), size);
            renderer.render(scene.world, scene.camera, target.target());
            CHECK(debug_state(gl) == before);
            gl.Enable(GL_RENDERER);  // an error: the renderer does not listen
            CHECK(device_of(renderer).take_messages().empty());
        }
        CHECK(debug_state(gl) == before);
        CHECK(gl.GetError() == GL_INVALID_ENUM);
    }
    gl.DebugMessageCallback(nullptr, nullptr);
}

TEST_CASE("with debug output, the log gets each error of the driver once") {
    const auto context = make_current_context();
    std::vector<std::string> lines;
    TestedRenderer renderer(context->get_proc(),
                            {.log = [&](std::string_view line) { lines.emplace_back(line); }});
    const gl::Functions& gl = device_of(renderer).gl();
    CHECK(lines.empty());
    for (int i = 0; i < 3; ++i) {
        gl.Enable(GL_RENDERER);
        CHECK(gl.GetError() == GL_INVALID_ENUM);
        CHECK(device_of(renderer).take_messages().size() == 1);
    }
    REQUIRE(lines.size() == 1);
    CHECK(lines[0].starts_with("OpenGL: "));
    CHECK(lines[0].find("GL_INVALID_ENUM") != std::string::npos);
}

TEST_CASE("a renderer reads its shaders from the given directory") {
    const auto context = make_current_context();
    CHECK_THROWS_AS(TestedRenderer(context->get_proc(), {.shader_directory = "/nowhere"}), gl::ProgramError);
    CHECK_NOTHROW(
        TestedRenderer(context->get_proc(), {.shader_directory = sandbox::shipped_file("shaders", "")}));
}

TEST_CASE("a context that does not suffice is one clear error") {
    auto context = make_current_context();
    const gl::GetProc proc = context->get_proc();
    CHECK_THROWS_WITH_AS(TestedRenderer{with_few_blocks(proc)},
                         "the driver offers 8 storage blocks a program; Candela needs 9", gl::GlError);
    const auto lacking = [&](const char* name) {
        return std::strcmp(name, "glClipControl") == 0 ? nullptr : proc(name);
    };
    CHECK_THROWS_WITH_AS(TestedRenderer{lacking}, "the OpenGL driver offers no function glClipControl",
                         gl::GlError);
    CHECK_THROWS_WITH_AS(TestedRenderer{gl::GetProc()}, "the host gives no function to look up GL functions",
                         gl::GlError);
    context.reset();
    CHECK_THROWS_WITH_AS(TestedRenderer{proc}, "no OpenGL context is current", gl::GlError);
}

TEST_CASE_FIXTURE(RenderFixture, "a target that cannot be drawn into is one clear error") {
    const Scene scene = cornell_box();
    configure(linear_configuration());
    const Picture before = render(scene, size);
    const auto refuse = [&](GLuint framebuffer, const char* why) {
        const Target target{.framebuffer = framebuffer, .size = size};
        CHECK(throws<gl::GlError>([&] { renderer.render(scene.world, scene.camera, target); }, why));
        const std::vector<glm::vec3> pixels(std::size_t{size.x} * size.y);
        CHECK(throws<gl::GlError>([&] { renderer.tone_map(pixels, target); }, why));
    };
    refuse(4711, "the target, framebuffer 4711, does not exist");
    const gl::Framebuffer empty(device, "empty");
    refuse(empty.name(), "is incomplete: there is no attachment");
    GLuint stale = 0;
    device.gl().CreateFramebuffers(1, &stale);
    device.gl().DeleteFramebuffers(1, &stale);
    refuse(stale, "does not exist");
    if (device.gl().CheckNamedFramebufferStatus(0, GL_DRAW_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
        refuse(0, "the target, framebuffer 0, is incomplete: the context has no default framebuffer");
    }
    gl::Framebuffer aside(device, "aside");
    const gl::Texture numbers(device, "numbers", {.size = size, .format = Format::r32ui});
    aside.attach_colour(0, numbers.name());
    aside.draw_buffers(1);
    refuse(aside.name(), "holds integers, which are no colours");
    const gl::Texture small(device, "small", {.size = size - glm::uvec2(0, 1)});
    aside.attach_colour(0, small.name());
    refuse(aside.name(), "too few for");
    const gl::Texture fitting(device, "fitting", {.size = size});
    aside.attach_colour(0, fitting.name());
    aside.draw_buffers(0);
    refuse(aside.name(), "draws colour into no attachment");
    aside.draw_buffers(1);
    const Target moved{.framebuffer = aside.name(), .size = size - 1U, .origin = {0, 2}};
    CHECK(throws<gl::GlError>([&] { renderer.render(scene.world, scene.camera, moved); }, "from (0, 2)"));
    CHECK(render(scene, size) == before);
}

TEST_CASE_FIXTURE(RenderFixture, "a frame in another context, or in none, is one clear error") {
    const Scene scene = cornell_box();
    configure(linear_configuration());
    const Picture before = render(scene, size);
    const RenderTarget target(device, size);
    const auto refuse = [&] {
        CHECK(throws<gl::GlError>([&] { renderer.render(scene.world, scene.camera, target.target()); },
                                  "another OpenGL context is current than the renderer's, or none"));
    };
    {
        const auto other = make_current_context();
        const gl::Device other_device(other->get_proc(), gl::DebugOutput::on);
        refuse();
        const TestedRenderer beside(other->get_proc());  // with objects of the same names
        refuse();
        CHECK(other_device.gl().GetError() == GL_NO_ERROR);
    }
    refuse();
    context->make_current();
    CHECK(render(scene, size) == before);
}

}  // TEST_SUITE("renderer options")
