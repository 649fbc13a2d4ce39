#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "renderer/context/library.hpp"
#include "renderer/gl/objects.hpp"
#include "tests/renderer/context_fixture.hpp"
#include "tests/throws.hpp"

TEST_SUITE("gl context") {

using namespace candela;

namespace {

/// A context with a device and a buffer in it.
struct Place {
    explicit Place(ContextKind kind, std::uint32_t mark) : context(HeadlessContext::create(kind)) {
        context->make_current();
        device = std::make_unique<gl::Device>(context->get_proc(), gl::DebugOutput::on);
        buffer = gl::Buffer(*device, "mark", std::array{mark});
    }
    ~Place() {
        context->make_current();
        buffer = {};
        device.reset();
    }
    Place(const Place&) = delete;
    Place& operator=(const Place&) = delete;

    std::unique_ptr<HeadlessContext> context;
    std::unique_ptr<gl::Device> device;
    gl::Buffer buffer;
};

/// Each context keeps its own objects and receives its own errors, in whatever order they become current.
void check_that_places_keep_apart(const std::vector<ContextKind>& kinds) {
    std::vector<std::unique_ptr<Place>> places;
    places.reserve(kinds.size());
    for (const ContextKind kind : kinds) {
        places.push_back(std::make_unique<Place>(kind, static_cast<std::uint32_t>(places.size())));
    }
    for (int round = 0; round < 3; ++round) {
        for (std::uint32_t i = 0; i < places.size(); ++i) {
            Place& place = *places[i];
            place.context->make_current();
            CHECK(place.buffer.download<std::uint32_t>() == std::vector{i});
            CHECK(place.device->take_messages().empty());
            place.device->gl().Enable(GL_RENDERER);
            CHECK(place.device->gl().GetError() == GL_INVALID_ENUM);
            for (std::uint32_t other = 0; other < places.size(); ++other) {
                CHECK(places[other]->device->take_messages().size() == (other == i ? 1 : 0));
            }
        }
    }
    for (const auto& place : places) CHECK(place->device->live()[gl::ObjectKind::buffer] == 1);
    std::swap(places.front(), places.back());  // destroy them in a different order
}

}  // namespace

TEST_CASE("a context describes its kind") {
    const auto context = HeadlessContext::create(tested_context());
    const std::string start = tested_context() == ContextKind::egl ? "EGL " : "OSMesa";
    CHECK(context->description().starts_with(start));
    CHECK(to_string(tested_context()) == (tested_context() == ContextKind::egl ? "egl" : "osmesa"));
}

TEST_CASE("a context is OpenGL 4.5 core") {
    const auto context = make_current_context();
    const gl::Device device(context->get_proc(), gl::DebugOutput::on);
    GLint profile = 0;
    device.gl().GetIntegerv(GL_CONTEXT_PROFILE_MASK, &profile);
    CHECK(profile == GL_CONTEXT_CORE_PROFILE_BIT);
}

TEST_CASE("two contexts of one kind do not affect each other") {
    check_that_places_keep_apart({tested_context(), tested_context()});
}

TEST_CASE("EGL and OSMesa contexts in one process do not affect each other") {
    if (!HeadlessContext::is_built(ContextKind::osmesa)) {
        MESSAGE("nothing to keep apart: this build is without OSMesa");
        return;
    }
    check_that_places_keep_apart({ContextKind::egl, ContextKind::osmesa});
    check_that_places_keep_apart(
        {ContextKind::egl, ContextKind::osmesa, ContextKind::egl, ContextKind::osmesa, ContextKind::egl});
}

TEST_CASE("destroying a context does not affect the others") {
    Place stays(tested_context(), 7);
    for (const ContextKind kind : {ContextKind::egl, ContextKind::osmesa}) {
        if (!HeadlessContext::is_built(kind)) continue;
        const Place goes(kind, 1);
        stays.context->make_current();
    }
    stays.context->make_current();
    CHECK(stays.buffer.download<std::uint32_t>() == std::vector{7U});
    CHECK(stays.device->take_messages().empty());
}

TEST_CASE("errors name a missing library or function") {
    CHECK(throws<ContextError>(
        [&] {
            static_cast<void>(Library({"libnowhere.so.1", "libneither.so.2"}));
        },
        "libnowhere.so.1"));
    const Library c{"libnowhere.so.1", "libc.so.6"};
    void (*function)() = nullptr;
    CHECK_THROWS_WITH_AS(c.find("no_such_function", function), "the library has no no_such_function",
                         ContextError);
    CHECK_NOTHROW(c.find("abort", function));
    CHECK(static_cast<bool>(function));
}

}  // TEST_SUITE("gl context")
