#include "renderer/tools/reference/path_tracer.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <glm/geometric.hpp>

#include <candela/scene/scene_error.hpp>
#include "tests/reference/pictures.hpp"
#include "tests/renderer/path_fixture.hpp"

TEST_SUITE("reference: tracer") {

using namespace candela;
using reference::Estimate;
using reference::Settings;

namespace {

Estimate traced(const Scene& scene, const Settings& settings) {
    return trace(reference::Scene(scene.world), scene.camera, settings);
}

bool is_same(const Estimate& a, const Estimate& b) {
    return a.direct.pixels == b.direct.pixels && a.indirect.pixels == b.indirect.pixels &&
           a.halves[0].pixels == b.halves[0].pixels && a.halves[1].pixels == b.halves[1].pixels &&
           a.hit == b.hit && a.edge == b.edge;
}

/// The correlation of the errors of two halves, over the red channel of all pixels.
double correlation(const tools::Picture& a, const tools::Picture& b, const tools::Picture& truth) {
    double ab = 0.0;
    double aa = 0.0;
    double bb = 0.0;
    for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
        const double x = static_cast<double>(a.pixels[i].r - truth.pixels[i].r);
        const double y = static_cast<double>(b.pixels[i].r - truth.pixels[i].r);
        ab += x * y;
        aa += x * x;
        bb += y * y;
    }
    return ab / std::sqrt(aa * bb);
}

}  // namespace

TEST_CASE("a seed gives the same picture on any number of threads") {
    const Scene scene = shipped_scene("glass");
    const Settings settings{.size = {40, 30}, .samples = 8, .seed = 3, .threads = 1};
    const Estimate once = traced(scene, settings);
    for (const unsigned threads : {0U, 1U, 2U, 5U}) {
        Settings other = settings;
        other.threads = threads;
        CHECK(is_same(traced(scene, other), once));
    }
    Settings other = settings;
    other.seed = 4;
    const Estimate elsewhere = traced(scene, other);
    CHECK(elsewhere.direct.pixels == once.direct.pixels);
    CHECK(elsewhere.indirect.pixels != once.indirect.pixels);
}

TEST_CASE("the halves are independent, as are seeds") {
    const Scene scene = cornell_box();
    const glm::uvec2 size(48, 48);
    const Estimate truth = traced(scene, {.size = size, .samples = 512, .bounces = 2});
    const Estimate one = traced(scene, {.size = size, .samples = 16, .bounces = 2, .seed = 1});
    const Estimate two = traced(scene, {.size = size, .samples = 16, .bounces = 2, .seed = 2});
    // With 2,304 pairs the correlation has a standard error of 2 %, or somewhat more if a few of them
    // dominate.
    CHECK(std::abs(correlation(one.halves[0], one.halves[1], truth.indirect)) < 0.15);
    CHECK(std::abs(correlation(one.halves[0], two.halves[0], truth.indirect)) < 0.15);
}

TEST_CASE("the sampled direct light of seeds is independent") {
    const Scene scene = shipped_scene("lamp");
    const auto direct = [&](std::uint32_t samples, std::uint32_t seed) {
        return traced(scene, {.size = {48, 48}, .samples = samples, .bounces = 0, .seed = seed}).direct;
    };
    const tools::Picture truth = direct(512, 9);
    for (std::uint32_t seed = 0; seed < 3; ++seed) {
        CAPTURE(seed);
        // The same limit as above.
        CHECK(std::abs(correlation(direct(4, seed), direct(4, seed + 1), truth)) < 0.15);
    }
}

TEST_CASE("indirect light is the mean of the halves, and the total is direct plus indirect light") {
    const Estimate estimate = traced(cornell_box(), {.size = {32, 32}, .samples = 4});
    const tools::Picture total = reference::total(estimate);
    for (std::size_t i = 0; i < total.pixels.size(); ++i) {
        const glm::vec3 mean = 0.5F * (estimate.halves[0].pixels[i] + estimate.halves[1].pixels[i]);
        CHECK(estimate.indirect.pixels[i] == mean);
        CHECK(total.pixels[i] == estimate.direct.pixels[i] + mean);
    }
}

TEST_CASE("without bounces there is no indirect light, and each bounce adds some") {
    const Scene scene = furnace_box(0.5F);
    const auto indirect = [&](std::optional<std::uint32_t> bounces) {
        const Estimate estimate = traced(scene, {.size = {32, 32}, .samples = 64, .bounces = bounces});
        return reference::mean_indirect(estimate, estimate.hit);
    };
    CHECK(indirect(0).value == 0.0);
    double last = 0.0;
    for (const std::uint32_t bounces : {1U, 2U, 3U, 6U}) {
        const double mean = indirect(bounces).value;
        CHECK(mean > last);
        last = mean;
    }
    // After six bounces, 0.5⁶ of the light is left.
    const reference::NoisyMean all = indirect(std::nullopt);
    CHECK(all.value > last);
    CHECK(all.value - last < all.value / 64.0 + 4.0 * all.error);
}

TEST_CASE("long paths in a nearly white room end without bias") {
    // In a closed box of albedo 0.97 paths get long: Russian roulette after many bounces must not change
    // the mean.
    Scene scene;
    add(scene.world, Transform{}, MeshInstance{box_inwards(1.0F, diffuse(glm::vec3(0.97F)))});
    scene.light = add(scene.world, Transform{}, PointLight{});
    scene.camera = add(scene.world, looking({0, 0, 0.9F}, {0, 0, 0}), Camera{.vertical_fov = 1.5F});
    const auto mean = [&](std::optional<std::uint32_t> bounces) {
        const Estimate estimate = traced(scene, {.size = {16, 16}, .samples = 128, .bounces = bounces});
        return reference::mean_indirect(estimate, estimate.hit);
    };
    // After bounce 400, 0.97⁴⁰⁰ = 5e-6 of the light is left.
    const reference::NoisyMean limited = mean(400);
    const reference::NoisyMean any = mean(std::nullopt);
    CHECK(std::abs(any.value - limited.value) < 4.0 * std::hypot(any.error, limited.error));
}

TEST_CASE("invalid requests are refused") {
    const Scene scene = cornell_box();
    CHECK_THROWS_AS(traced(scene, {.size = {8, 8}, .samples = 3}), std::invalid_argument);
    CHECK_THROWS_AS(traced(scene, {.size = {8, 8}, .samples = 0}), std::invalid_argument);
    CHECK_THROWS_AS(traced(scene, {.size = {8, 8}, .samples = 2, .first_sample = 1}), std::invalid_argument);
    CHECK_THROWS_AS(traced(scene, {.size = {8, 0}, .samples = 2}), std::invalid_argument);
    CHECK_THROWS_AS(
        static_cast<void>(trace(reference::Scene(scene.world), scene.light, {.size = {8, 8}, .samples = 2})),
        SceneError);
}

TEST_CASE("an empty world is black, and so is an unlit one") {
    Scene scene;
    scene.camera = add(scene.world, Transform{}, Camera{});
    const Estimate empty = traced(scene, {.size = {8, 8}, .samples = 2});
    CHECK(std::ranges::count(empty.hit, 1) == 0);
    add(scene.world, Transform{}, MeshInstance{box_inwards(1.0F, diffuse(glm::vec3(0.5F)))});
    const Estimate unlit = traced(scene, {.size = {8, 8}, .samples = 2});
    CHECK(std::ranges::count(unlit.hit, 1) == 64);
    CHECK(std::ranges::all_of(total(unlit).pixels, [](glm::vec3 p) { return p == glm::vec3(0.0F); }));
}

}  // TEST_SUITE("reference: tracer")
