#include <doctest/doctest.h>

#include <cstddef>
#include <set>
#include <vector>

#include "renderer/gl/texture.hpp"
#include "renderer/gl/timer.hpp"
#include "tests/renderer/context_fixture.hpp"

TEST_SUITE("gl timer") {

using namespace candela;
using namespace candela::gl;

namespace {

/// Times frames of two passes, which clear a texture.
void time_frames(Device& device, Timer& timer, std::uint64_t first, std::uint64_t count) {
    const Texture texture(device, "work", {.size = {64, 64}});
    for (std::uint64_t frame = first; frame < first + count; ++frame) {
        timer.begin_frame(frame);
        for (const std::uint32_t pass : {7U, 3U}) {
            timer.begin_pass(pass);
            device.gl().ClearTexImage(texture.name(), 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
            timer.end_pass();
        }
        timer.end_frame();
    }
}

}  // namespace

TEST_CASE_FIXTURE(GlFixture, "the times of every frame are returned once, in order, with its passes") {
    Timer timer(device);
    CHECK(timer.collect().empty());
    std::vector<FrameTime> times;
    for (std::uint64_t frame = 0; frame < 20; ++frame) {
        time_frames(device, timer, frame, 1);
        const std::size_t before = timer.pending();
        const auto arrived = timer.collect();
        CHECK(arrived.size() + timer.pending() == before);
        times.insert(times.end(), arrived.begin(), arrived.end());
    }
    const auto rest = timer.finish();
    times.insert(times.end(), rest.begin(), rest.end());
    CHECK(timer.pending() == 0);
    REQUIRE(times.size() == 20);
    for (std::size_t i = 0; i < times.size(); ++i) {
        CHECK(times[i].frame == i);
        REQUIRE(times[i].passes.size() == 2);
        CHECK(times[i].passes[0].pass == 7);
        CHECK(times[i].passes[1].pass == 3);
        CHECK(times[i].passes[0].ms >= 0.0);
        // Passes are inside their frame; the microsecond allows for the rounding of the sums.
        CHECK(times[i].passes[0].ms + times[i].passes[1].ms <= times[i].ms + 1e-3);
    }
}

TEST_CASE_FIXTURE(GlFixture, "collecting times never waits for a query without a result") {
    // A driver whose results never arrive, and which would wait forever if it were asked for one.
    static bool asked;
    asked = false;
    const auto slow = [proc = context->get_proc()](const char* name) -> void (*)() {
        const std::string_view wanted = name;
        const PFNGLGETQUERYOBJECTIVPROC not_yet = [](GLuint, GLenum, GLint* value) { *value = GL_FALSE; };
        const PFNGLGETQUERYOBJECTUI64VPROC wait = [](GLuint, GLenum, GLuint64*) { asked = true; };
        if (wanted == "glGetQueryObjectiv") return reinterpret_cast<void (*)()>(not_yet);
        if (wanted == "glGetQueryObjectui64v") return reinterpret_cast<void (*)()>(wait);
        return proc(name);
    };
    Device slow_device(slow, DebugOutput::on);
    Timer timer(slow_device);
    time_frames(slow_device, timer, 0, 50);
    CHECK(timer.collect().empty());
    CHECK(timer.pending() == 50);
    CHECK_FALSE(asked);
}

TEST_CASE_FIXTURE(GlFixture, "finishing reads every result, although none is said to be available") {
    // OpenGL lets a driver say so even after glFinish.
    const auto silent = [proc = context->get_proc()](const char* name) -> void (*)() {
        const PFNGLGETQUERYOBJECTIVPROC not_yet = [](GLuint, GLenum, GLint* value) { *value = GL_FALSE; };
        const bool asks = std::string_view(name) == "glGetQueryObjectiv";
        return asks ? reinterpret_cast<void (*)()>(not_yet) : proc(name);
    };
    Device silent_device(silent, DebugOutput::on);
    Timer timer(silent_device);
    time_frames(silent_device, timer, 0, 3);
    CHECK(timer.finish().size() == 3);
    CHECK(timer.pending() == 0);
}

TEST_CASE_FIXTURE(GlFixture, "queries are reused") {
    Timer timer(device);
    time_frames(device, timer, 0, 3);
    CHECK(timer.finish().size() == 3);
    const std::uint32_t queries = device.live()[ObjectKind::query];
    CHECK(queries == 3 * 6);
    time_frames(device, timer, 3, 3);
    CHECK(timer.finish().size() == 3);
    CHECK(device.live()[ObjectKind::query] == queries);
}

TEST_CASE_FIXTURE(GlFixture, "passes outside a frame are not timed") {
    Timer timer(device);
    timer.begin_pass(1);
    timer.end_pass();
    CHECK(timer.finish().empty());
    CHECK(device.live()[ObjectKind::query] == 0);
}

TEST_CASE_FIXTURE(GlFixture, "a frame that was not ended is dropped") {
    Timer timer(device);
    timer.begin_frame(0);
    timer.begin_pass(1);
    time_frames(device, timer, 1, 1);
    const auto times = timer.finish();
    REQUIRE(times.size() == 1);
    CHECK(times[0].frame == 1);
}

}  // TEST_SUITE("gl timer")
