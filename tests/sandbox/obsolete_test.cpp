#include "sandbox/window/obsolete.hpp"

#include <doctest/doctest.h>

#include <array>
#include <functional>
#include <memory>

namespace candela::sandbox {

TEST_SUITE("obsolete") {

namespace {

using namespace std::chrono_literals;

FrameRequest some_request() {
    FrameRequest request;
    request.world = std::make_shared<const World>();
    request.size = {640, 360};
    return request;
}

/// The same view after something in it has moved.
FrameRequest moved(FrameRequest request) {
    request.world = std::make_shared<const World>();
    request.input = Clock::time_point(1s);
    return request;
}

/// The ways in which a request shows something else than motion.
const std::array<std::function<void(FrameRequest&)>, 4> changes{
    [](FrameRequest& request) {
        request.size = {641, 360};
    },
    [](FrameRequest& request) { request.configuration.vpls.count += 1; },
    [](FrameRequest& request) { request.other = Configuration(); },
    [](FrameRequest& request) { request.inspection = Inspection(); }};

double pixels(glm::uvec2 size) {
    return static_cast<double>(size.x) * size.y;
}

}  // namespace

TEST_CASE("refinement gives way at once") {
    const FrameRequest request = some_request();
    CHECK(is_obsolete({.refines = true}, request, moved(request)));
    CHECK(is_obsolete({.refines = true, .given_up = 1000}, request, moved(request)));
}

TEST_CASE("who drags without a pause sees a picture of each request") {
    const FrameRequest request = some_request();
    CHECK_FALSE(is_obsolete({}, request, moved(request)));
    CHECK_FALSE(is_obsolete({.age = 100s}, request, moved(request)));
}

TEST_CASE("an answer gives way to something else unless it is soon done, but not for ever") {
    const FrameRequest request = some_request();
    for (const auto& change : changes) {
        FrameRequest changed = moved(request);
        change(changed);
        CHECK_FALSE(is_obsolete({.age = 10ms}, request, changed));
        CHECK(is_obsolete({.age = 1s}, request, changed));
        CHECK_FALSE(is_obsolete({.age = 1s, .given_up = 10}, request, changed));
    }
}

TEST_CASE("the first picture of another scene, in full quality, gives way to what moves in it") {
    FrameRequest opened = some_request();
    opened.cut = true;
    CHECK(is_obsolete({}, opened, moved(some_request())));
    // Not to the same scene once more: an animation that begins anew all the time.
    CHECK_FALSE(is_obsolete({}, opened, moved(opened)));
    CHECK_FALSE(is_obsolete({.given_up = 10}, opened, moved(some_request())));
}

TEST_CASE("a first picture is small unless a whole one is known to be quick") {
    constexpr glm::uvec2 large(4000, 2500);
    constexpr double most = 640.0 * 360.0 * 1.01;
    CHECK(pixels(first_size(large, {})) < most);
    // One pixel tells nothing of ten million.
    CHECK(pixels(first_size(large, FinishedFrame{{1, 1}, {1, 1}, 0.02})) < most);
    CHECK(pixels(first_size(large, FinishedFrame{{1280, 720}, {1280, 720}, 0.5})) < most);
    CHECK(first_size(large, FinishedFrame{{1280, 720}, {1280, 720}, 0.002}) == large);
    CHECK(first_size({320, 200}, {}) == glm::uvec2(320, 200));
    CHECK(first_size({1, 1}, {}) == glm::uvec2(1));
}

TEST_CASE("a small first picture has the shape of the whole one") {
    for (const glm::uvec2 asked : {glm::uvec2(4000, 2500), {2500, 4000}, {5000, 1000}}) {
        const glm::dvec2 first(first_size(asked, {}));
        // Both sides are whole numbers of some hundred pixels.
        CHECK(first.x / first.y == doctest::Approx(glm::dvec2(asked).x / asked.y).epsilon(0.01));
    }
    CHECK(first_size({1U << 20U, 1}, {}).y == 1);
}

TEST_CASE("while the size stays, all pixels are asked for: the renderer knows what they cost") {
    constexpr glm::uvec2 size(1280, 720);
    CHECK(first_size(size, FinishedFrame{size, size, 0.5}) == size);
    CHECK(first_size({1300, 740}, FinishedFrame{size, size, 0.5}) == glm::uvec2(1300, 740));
    CHECK(first_size(size, FinishedFrame{{4000, 2500}, {1920, 1200}, 5.0}) == size);
    // Except those of a picture whose last step alone takes long.
    constexpr glm::uvec2 large(4000, 2500);
    const glm::uvec2 first = first_size(large, FinishedFrame{large, large, 5.0});
    CHECK(pixels(first) < 1920.0 * 1080.0 * 1.01);
    CHECK(first_size(large, FinishedFrame{large, first, 1.0}) == first);
}
}  // TEST_SUITE("obsolete")

}  // namespace candela::sandbox
