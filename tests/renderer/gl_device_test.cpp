#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

#include "renderer/gl/objects.hpp"
#include "renderer/gpu/gpu.hpp"
#include "tests/renderer/context_fixture.hpp"

TEST_SUITE("gl device") {

using namespace candela;
using gl::DebugOutput;
using gl::Device;

namespace {

bool holds_error(const std::vector<gl::DebugMessage>& messages) {
    return std::any_of(messages.begin(), messages.end(),
                       [](const gl::DebugMessage& message) { return message.type == GL_DEBUG_TYPE_ERROR; });
}

/// An invalid call; its error flag is cleared again.
void provoke_error(const Device& device) {
    device.gl().Enable(GL_RENDERER);  // no capability
    CHECK(device.gl().GetError() == GL_INVALID_ENUM);
}

std::string message_of(const gl::GetProc& get_proc) {
    try {
        const Device device(get_proc, DebugOutput::on);
    } catch (const gl::GlError& error) {
        return error.what();
    }
    return {};
}

// A driver that is too old.
const GLubyte* old_string(GLenum name) {
    return reinterpret_cast<const GLubyte*>(name == GL_RENDERER ? "Old Faithful" : "3.3 Geyser");
}
void old_integer(GLenum name, GLint* value) {
    *value = name == GL_MAJOR_VERSION || name == GL_MINOR_VERSION ? 3 : 0;
}
using Proc = void (*)();

Proc old_proc(const char* name) {
    if (std::strcmp(name, "glGetString") == 0) return reinterpret_cast<Proc>(&old_string);
    if (std::strcmp(name, "glGetIntegerv") == 0) return reinterpret_cast<Proc>(&old_integer);
    return nullptr;
}

const GLubyte* no_string(GLenum) {
    return nullptr;
}
Proc proc_without_context(const char* name) {
    return std::strcmp(name, "glGetString") == 0 ? reinterpret_cast<Proc>(&no_string) : old_proc(name);
}

/// A debug callback of the host.
struct HostLog {
    mutable int messages = 0;
    static void APIENTRY receive(GLenum, GLenum, GLuint, GLenum, GLsizei, const GLchar*, const void* user) {
        ++static_cast<const HostLog*>(user)->messages;
    }
};

void* debug_user(const gl::Functions& gl) {
    void* user = nullptr;
    gl.GetPointerv(GL_DEBUG_CALLBACK_USER_PARAM, &user);
    return user;
}

}  // namespace

TEST_CASE_FIXTURE(GlFixture, "the second driver is the one that the environment asks for") {
    // Mesa falls back to its own one without a word.
    const char* const wanted = std::getenv("MESA_LOADER_DRIVER_OVERRIDE");
    if (wanted == nullptr || std::string_view(wanted) != "zink") return;
    if (tested_context() == ContextKind::egl) CHECK(device.renderer().starts_with("zink"));
}

TEST_CASE_FIXTURE(GlFixture, "a device reports its driver, limits and extensions") {
    CHECK_FALSE(device.renderer().empty());
    CHECK_FALSE(device.version().empty());
    // The minimum values of the OpenGL 4.5 core specification, tables 23.53 and following.
    const gl::Limits& limits = device.limits();
    CHECK(limits.texture_size >= 16384);
    CHECK(limits.texture_layers >= 2048);
    CHECK(limits.storage_blocks >= 8);
    CHECK(limits.storage_bindings >= 8);
    CHECK(limits.uniform_bindings >= 84);
    CHECK(limits.texture_units >= 16);
    CHECK(device.has_extension("GL_ARB_direct_state_access"));
    CHECK_FALSE(device.has_extension("GL_ARB_direct"));
    CHECK(device.live() == gl::ObjectCounts{});
}

TEST_CASE_FIXTURE(GlFixture, "the error names a missing function") {
    const auto lacking = [proc = context->get_proc()](const char* name) {
        return std::strcmp(name, "glDispatchCompute") == 0 ? nullptr : proc(name);
    };
    CHECK(message_of(lacking) == "the OpenGL driver offers no function glDispatchCompute");
    CHECK_THROWS_AS(static_cast<void>(gl::load_functions(lacking)), gl::GlError);
}

TEST_CASE_FIXTURE(GlFixture, "the error names a limit that is too low") {
    CHECK_NOTHROW(require_limits(device.limits()));
    gl::Limits limits = device.limits();
    limits.storage_blocks = 4;
    CHECK_THROWS_WITH_AS(require_limits(limits),
                         "the driver offers 4 storage blocks a program; Candela needs 9", gl::GlError);
    limits = device.limits();
    limits.drawing_storage_blocks = 0;
    CHECK_THROWS_WITH_AS(require_limits(limits),
                         "the driver offers 0 storage blocks of a vertex or geometry shader; Candela needs 1",
                         gl::GlError);
    limits = device.limits();
    limits.texture_units = 4;
    CHECK_THROWS_WITH_AS(require_limits(limits), "the driver offers 4 texture units; Candela needs 16",
                         gl::GlError);
}

TEST_CASE("errors say that the driver is too old, or that no context is current") {
    CHECK(message_of(old_proc) == "OpenGL 4.5 is needed; Old Faithful offers 3.3 Geyser");
    CHECK(message_of(proc_without_context) == "no OpenGL context is current");
    CHECK(message_of([](const char*) -> Proc { return nullptr; }) ==
          "the host's function look-up knows no glGetString or glGetIntegerv");
}

TEST_CASE_FIXTURE(GlFixture, "the debug log keeps errors until they are taken") {
    provoke_error(device);
    provoke_error(device);
    const auto messages = device.take_messages();
    REQUIRE(messages.size() == 1);
    CHECK(messages[0].type == GL_DEBUG_TYPE_ERROR);
    CHECK(messages[0].is_error());
    CHECK(messages[0].times == 2);
    CHECK(messages[0].text.find("GL_INVALID_ENUM") != std::string::npos);
    CHECK(device.take_messages().empty());
}

TEST_CASE_FIXTURE(GlFixture,
                  "the debug log keeps each error of another wording, whatever the driver's number for it") {
    for (const char* words : {"one error", "another error", "one error"}) {
        device.gl().DebugMessageInsert(GL_DEBUG_SOURCE_APPLICATION, GL_DEBUG_TYPE_ERROR, 7,
                                       GL_DEBUG_SEVERITY_HIGH, -1, words);
    }
    const auto messages = device.take_messages();
    REQUIRE(messages.size() == 2);
    CHECK(messages[0].times == 2);
    CHECK(messages[1].text == "another error");
}

TEST_CASE_FIXTURE(GlFixture, "performance messages are no errors, and notifications are not kept") {
    const auto say = [&](GLenum type, GLuint id, GLenum severity) {
        device.gl().DebugMessageInsert(GL_DEBUG_SOURCE_APPLICATION, type, id, severity, -1, "word");
    };
    say(GL_DEBUG_TYPE_PERFORMANCE, 1, GL_DEBUG_SEVERITY_MEDIUM);
    say(GL_DEBUG_TYPE_OTHER, 2, GL_DEBUG_SEVERITY_NOTIFICATION);
    say(GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR, 3, GL_DEBUG_SEVERITY_MEDIUM);
    say(GL_DEBUG_TYPE_OTHER, 4, GL_DEBUG_SEVERITY_HIGH);
    const auto messages = device.take_messages();
    REQUIRE(messages.size() == 3);
    CHECK_FALSE(messages[0].is_error());
    CHECK(messages[1].is_error());
    CHECK(messages[2].is_error());
    CHECK(messages[2].text == "word");
}

TEST_CASE_FIXTURE(GlFixture, "the host's own debug callback gets all messages and is restored") {
    HostLog host;
    device.gl().DebugMessageCallback(&HostLog::receive, &host);
    device.gl().Disable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    {
        Device guest(context->get_proc(), DebugOutput::on);
        CHECK(device.gl().IsEnabled(GL_DEBUG_OUTPUT_SYNCHRONOUS) == GL_TRUE);
        provoke_error(guest);
        CHECK(host.messages == 1);
        CHECK(holds_error(guest.take_messages()));
    }
    CHECK(debug_user(device.gl()) == &host);
    CHECK(device.gl().IsEnabled(GL_DEBUG_OUTPUT) == GL_TRUE);
    CHECK(device.gl().IsEnabled(GL_DEBUG_OUTPUT_SYNCHRONOUS) == GL_FALSE);
    provoke_error(device);
    CHECK(host.messages == 2);
    device.gl().DebugMessageCallback(nullptr, nullptr);
}

TEST_CASE("devices of one context may be destroyed in any order") {
    const auto context = make_current_context();
    const gl::Functions gl = gl::load_functions(context->get_proc());
    HostLog host;
    gl.DebugMessageCallback(&HostLog::receive, &host);
    gl.Enable(GL_DEBUG_OUTPUT);
    gl.Disable(GL_DEBUG_OUTPUT_SYNCHRONOUS);

    std::optional<Device> first(std::in_place, context->get_proc(), DebugOutput::on);
    std::optional<Device> second(std::in_place, context->get_proc(), DebugOutput::on);
    std::optional<Device> third(std::in_place, context->get_proc(), DebugOutput::on);
    second.reset();
    provoke_error(*third);
    CHECK(holds_error(first->take_messages()));
    first.reset();
    provoke_error(*third);
    CHECK(third->take_messages().at(0).times == 2);
    CHECK(host.messages == 2);
    third.reset();
    CHECK(debug_user(gl) == &host);
    CHECK(gl.IsEnabled(GL_DEBUG_OUTPUT_SYNCHRONOUS) == GL_FALSE);
}

}  // TEST_SUITE("gl device")
