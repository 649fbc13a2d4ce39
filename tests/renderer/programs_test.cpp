#include <doctest/doctest.h>

#include <array>
#include <string>
#include <string_view>
#include <utility>

#include "renderer/gpu/programs.hpp"
#include "tests/renderer/context_fixture.hpp"
#include "tests/throws.hpp"

TEST_SUITE("programs") {

using namespace candela;

namespace {

std::string events;      // "l": a program is linked, "s": a status is asked that the driver has to wait for
bool says_done = false;  // the driver's answer to whether it is done
PFNGLLINKPROGRAMPROC link_program = nullptr;
PFNGLGETPROGRAMIVPROC get_program = nullptr;
PFNGLGETSHADERIVPROC get_shader = nullptr;

void note_link(GLuint program) {
    events += 'l';
    link_program(program);
}
void note_program(GLuint program, GLenum what, GLint* value) {
    if (what == GL_COMPLETION_STATUS_KHR) {
        *value = says_done ? GL_TRUE : GL_FALSE;
        return;
    }
    if (what == GL_LINK_STATUS) events += 's';
    get_program(program, what, value);
}
void note_shader(GLuint shader, GLenum what, GLint* value) {
    if (what == GL_COMPILE_STATUS) events += 's';
    get_shader(shader, what, value);
}

/// The driver's functions; some note their calls.
gl::GetProc noting(const gl::GetProc& get_proc) {
    return [get_proc](const char* name) -> void (*)() {
        const auto found = get_proc(name);
        const auto replace = [&](auto& driver, auto* with) {
            driver = reinterpret_cast<std::remove_reference_t<decltype(driver)>>(found);
            return reinterpret_cast<void (*)()>(with);
        };
        const std::string_view wanted(name);
        if (wanted == "glLinkProgram") return replace(link_program, &note_link);
        if (wanted == "glGetProgramiv") return replace(get_program, &note_program);
        if (wanted == "glGetShaderiv") return replace(get_shader, &note_shader);
        return found;
    };
}

constexpr std::array<gl::EmbeddedShader, 3> files{
    {{"a.comp", "layout(local_size_x = 1) in;\nvoid main() {}\n"},
     {"bad.comp", "layout(local_size_x = 1) in;\nvoid main() { nothing(); }\n"},
     {"worse.comp", "layout(local_size_x = 1) in;\nvoid main() { less(); }\n"}}};

class ProgramsTests : public GlFixture {
 protected:
    explicit ProgramsTests() { events.clear(); }

    void request(const char* file, const char* word) { static_cast<void>(programs.request({file}, {word})); }

    gl::Device noted{noting(context->get_proc()), gl::DebugOutput::off};
    Log log{{}};
    Programs programs{noted, gl::ShaderLibrary(files), {}, log};
};

}  // namespace

TEST_CASE_FIXTURE(ProgramsTests, "all programs are started before the driver has to wait for any") {
    says_done = false;
    for (const char* const word : {"A", "B", "C"}) request("a.comp", word);
    CHECK(events.empty());
    CHECK(programs.compile());
    CHECK(events == "lllsss");
}

TEST_CASE_FIXTURE(ProgramsTests, "those that are done are told while others are started") {
    if (noted.gl().MaxShaderCompilerThreadsKHR == nullptr) return;
    says_done = true;
    for (const char* const word : {"A", "B"}) request("a.comp", word);
    CHECK(programs.compile([](std::size_t done, std::size_t) {
        events += std::to_string(done);
        return true;
    }));
    CHECK(events == "0ls1ls2");
}

TEST_CASE_FIXTURE(ProgramsTests, "a program is requested once, and compiled once") {
    says_done = false;
    const gl::Program& first = programs.request({"a.comp"}, {});
    CHECK(&programs.request({"a.comp"}, {}) == &first);
    CHECK_FALSE(first);
    CHECK(programs.compile());
    CHECK(first);
    CHECK(&programs.request({"a.comp"}, {}) == &first);
    CHECK(&programs.compiled({"a.comp"}, {}) == &first);
    CHECK(programs.compile());
    CHECK(events == "ls");
}

TEST_CASE_FIXTURE(ProgramsTests, "the first of several faults is the error, and what is ready stays") {
    for (const bool done : {false, true}) {
        says_done = done;
        const gl::Program& good = programs.request({"a.comp"}, {done ? "A" : "B"});
        request("bad.comp", "A");
        request("worse.comp", "A");
        CHECK(throws<gl::ProgramError>([&] { programs.compile(); }, "shaders/bad.comp:2: "));
        CHECK(good);
        // The others are not requested any more.
        CHECK(programs.compile());
    }
    CHECK(throws<gl::ProgramError>([&] { static_cast<void>(programs.compiled({"worse.comp"}, {})); },
                                   "shaders/worse.comp:2: "));
    CHECK(throws<gl::ProgramError>([&] { request("none.comp", "A"); },
                                   "shaders/none.comp: there is no such shader file"));
}

TEST_CASE_FIXTURE(ProgramsTests, "requests can be forgotten") {
    request("bad.comp", "A");
    programs.forget_requests();
    CHECK(programs.compile([](std::size_t done, std::size_t total) {
        CHECK(done == 0);
        CHECK(total == 0);
        return true;
    }));
    CHECK(events.empty());
}

}  // TEST_SUITE("programs")
