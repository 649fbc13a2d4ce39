// The sky in glossy surfaces: bright parts without dots or blotches, and suns once.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <numeric>

#include "renderer/passes/sky/sky_tree.hpp"
#include "tests/renderer/gloss.hpp"
#include "tests/renderer/path_fixture.hpp"

TEST_SUITE("glossy sky") {

using namespace candela;

namespace {

constexpr double pi = std::numbers::pi;

/// A black sky with a disc of radiance 1 of this radius, radians, around a unit direction.
std::shared_ptr<const SkyPicture> sky_with_disc(glm::vec3 axis, float radius, std::uint32_t width = 512) {
    std::vector<glm::vec3> texels;
    for (std::uint32_t i = 0; i < width * width / 2; ++i) {
        const glm::vec3 direction =
            sky_direction((glm::vec2(i % width, i / width) + 0.5F) / glm::vec2(width, width / 2));
        texels.emplace_back(glm::dot(direction, axis) > std::cos(radius) ? 1.0F : 0.0F);
    }
    return std::make_shared<const SkyPicture>(SkyPicture{width, width / 2, std::move(texels)});
}

/// Radiance towards `viewer` of a ground that reflects all light in the mirror direction, of such a disc.
double ground_under_disc(const glm::dvec3& axis, double radius, const glm::dvec3& viewer, double alpha) {
    constexpr int steps = 64;
    const glm::dvec3 across = glm::normalize(glm::cross(axis, glm::dvec3(0.1, 0.2, 1)));
    const glm::dvec3 along = glm::cross(axis, across);
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) {
        const double cosine = 1.0 - (1.0 - std::cos(radius)) * (i + 0.5) / steps;
        const double sine = std::sqrt(1.0 - cosine * cosine);
        for (int j = 0; j < steps; ++j) {
            const double angle = 2.0 * pi * (j + 0.5) / steps;
            const glm::dvec3 light =
                cosine * axis + sine * (std::cos(angle) * across + std::sin(angle) * along);
            if (light.y > 0.0) sum += facets_towards(light, viewer, {0, 1, 0}, alpha) * light.y;
        }
    }
    return sum * 2.0 * pi * (1.0 - std::cos(radius)) / (steps * steps);
}

struct Spread {
    double mean;
    double deviation;  ///< standard deviation
};

Spread spread_of(const Picture& picture) {
    double sum = 0.0, squares = 0.0;
    for (const glm::vec3& pixel : picture.pixels) {
        sum += static_cast<double>(pixel.g);
        squares += static_cast<double>(pixel.g) * static_cast<double>(pixel.g);
    }
    const auto count = static_cast<double>(picture.pixels.size());
    return {sum / count, std::sqrt(std::max(squares / count - sum * sum / (count * count), 0.0))};
}

}  // namespace

TEST_CASE("each level of the tree over a sky has all light above the mean") {
    constexpr float radius = 0.1F;
    const glm::vec3 axis = glm::normalize(glm::vec3(1, 2, 3));
    const SkyTree tree = sky_tree(sky_with_disc(axis, radius).get(), {});
    REQUIRE(tree.levels.size() == 8);
    REQUIRE(tree.levels.back().size() == 1);
    // Three channels; what shares the disc's solid angle is not above the mean.
    const double disc = 2.0 * pi * (1.0 - std::cos(static_cast<double>(radius)));
    const double above = 3.0 * disc * (1.0 - disc / (4.0 * pi));
    for (const std::vector<glm::vec4>& level : tree.levels) {
        const double sum = std::accumulate(
            level.begin(), level.end(), 0.0,
            [](double before, glm::vec4 cell) { return before + static_cast<double>(cell.w); });
        // The disc has 130 texels, its edge is as uneven as these; cells at its edge are larger than it.
        CHECK(sum == doctest::Approx(above).epsilon(0.03));
    }
    const glm::vec4& root = tree.levels.back()[0];
    CHECK(glm::length(glm::normalize(glm::vec3(root)) - axis) < 0.01F);
    CHECK(static_cast<double>(tree.share) == doctest::Approx(above / (3.0 * disc)).epsilon(0.03));
}

TEST_CASE("a sky that is the same everywhere has nothing bright, nor has one with a sun alone") {
    const SkyPicture even{64, 32, std::vector<glm::vec3>(64 * 32, glm::vec3(2.0F))};
    CHECK(sky_tree(&even, {}).share < 1e-5F);
    const auto sun = sky_with_disc(glm::normalize(glm::vec3(-1, 1, 0)), 0.008F, 1024);
    CHECK(sky_tree(sun.get(), split_sky(sun.get(), 1).suns).share == 0.0F);
}

TEST_CASE_FIXTURE(RenderFixture, "rough metal shows the integral over a bright part of the sky") {
    Configuration configuration = linear_configuration();
    configuration.indirect = false;
    configure(configuration);
    const glm::dvec3 viewer = glm::normalize(glm::dvec3(2, 2, 0));
    constexpr float radius = 0.12F;
    for (const float roughness : {0.25F, 0.4F, 0.55F}) {
        CAPTURE(roughness);
        // Where mirrors would show it, and aside.
        for (const glm::vec3 from : {glm::vec3(-1, 1, 0), glm::vec3(-1, 1.4F, 0.3F)}) {
            CAPTURE(from.y);
            const glm::vec3 axis = glm::normalize(from);
            Scene scene = seen_ground(metal(glm::vec3(1.0F), roughness));
            Environment sky;
            sky.radiance = glm::vec3(50.0F);
            sky.picture = sky_with_disc(axis, radius);
            add(scene.world, sky);
            const double alpha = static_cast<double>(roughness) * static_cast<double>(roughness);
            const double expected =
                50.0 * ground_under_disc(glm::dvec3(axis), static_cast<double>(radius), viewer, alpha);
            const Spread seen = spread_of(render(scene, {48, 48}));
            // The quotient of two sums over 25 rays is off by about a 25th.
            CHECK(relative_error(seen.mean, expected) < 0.08);
            // Half of the rays go to the disc: 1 / √12. By the lobe alone, one ray in 20 finds it at a
            // roughness of 0.55: 1 / √1.3.
            CHECK(seen.deviation < 0.4 * seen.mean);
        }
    }
}

TEST_CASE_FIXTURE(RenderFixture, "metal reflects the sun of a sky once, as a directional light") {
    Configuration configuration = linear_configuration();
    configuration.indirect = false;
    configure(configuration);
    const glm::vec3 axis = glm::normalize(glm::vec3(-1, 1, 0));
    for (const float roughness : {0.0F, 0.15F, 0.4F}) {
        CAPTURE(roughness);
        Scene by_sky = seen_ground(metal(glm::vec3(0.8F), roughness));
        Scene by_light = by_sky;
        Environment sky;
        sky.radiance = glm::vec3(1e4F);
        sky.picture = sky_with_disc(axis, 0.008F, 1024);
        const SplitSky split = split_sky(sky.picture.get(), 1);
        REQUIRE(split.suns.size() == 1);
        add(by_sky.world, sky);
        add(by_light.world, looking(split.suns[0].direction, glm::vec3(0.0F)),
            DirectionalLight{.illuminance = 1e4F * split.suns[0].light.g});
        const double expected = luminance_at_middle(render(by_light, few));
        renderer.invalidate();
        REQUIRE(expected > 0.0);
        // The same light, but for the rounding of its direction, in a lobe of 0.004 radians.
        CHECK(luminance_at_middle(render(by_sky, few)) == doctest::Approx(expected).epsilon(0.01));
    }
}

}  // TEST_SUITE("glossy sky")
