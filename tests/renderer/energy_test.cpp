#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tests/renderer/scene_builder.hpp"

TEST_SUITE("energy") {

using namespace candela;

namespace {

constexpr double pi = std::numbers::pi;
constexpr glm::uvec2 size{4, 4};

/// The largest |a - b| over the channels, relative to the largest channel of b.
double relative_error(glm::dvec3 a, glm::dvec3 b) {
    const glm::dvec3 d = glm::abs(a - b);
    return std::max({d.r, d.g, d.b}) / std::max({b.r, b.g, b.b});
}

glm::dvec3 accounted(const EnergyAccount& flux) {
    return flux.absorbed + flux.escaped + flux.truncated + flux.roulette;
}

class Energy : public RenderFixture {
 protected:
    VplReport trace(const Scene& scene, const VplSettings& settings) {
        Configuration configuration = linear_configuration();
        configuration.vpls = settings;
        configuration.vpls.placement = VplPlacement::paths;
        configure(configuration);
        renderer.invalidate();
        static_cast<void>(render(scene, size));
        const auto report = renderer.report().vpls;
        REQUIRE(report);
        CHECK(report->requested == settings.count);
        CHECK(report->alive <= settings.count);
        return *report;
    }
};

/// Three walls and a floor of different albedos, with lights of every kind: paths escape, and Russian
/// roulette is not uniform.
Scene open_scene() {
    Scene scene = cornell_box();
    add(scene.world, looking({0.5F, 1.2F, 1.5F}, {-0.3F, 0.4F, 0}),
        SpotLight{.colour = {0.2F, 1.0F, 0.4F}, .intensity = 9.0F, .inner_cone = 0.2F, .outer_cone = 0.5F});
    add(scene.world, looking({0.3F, 0.5F, 3.0F}, {0, 0, 0}), DirectionalLight{.illuminance = 2.0F});
    return scene;
}

}  // namespace

TEST_CASE_FIXTURE(Energy, "all flux that is emitted into a closed box is absorbed or truncated") {
    for (const float albedo : {0.3F, 0.8F}) {
        for (const std::uint32_t bounces : {1U, 2U, 5U}) {
            CAPTURE(albedo);
            CAPTURE(bounces);
            const VplReport vpls = trace(furnace_box(albedo), {.count = 500, .bounces = bounces});
            const EnergyAccount& flux = vpls.flux;
            // A light of 1 cd emits 4π lm; these are sums of a few hundred floats.
            CHECK(relative_error(flux.emitted, glm::dvec3(4.0 * pi)) < 1e-4);
            CHECK(relative_error(accounted(flux), flux.emitted) < 1e-3);
            CHECK(flux.escaped == glm::dvec3(0.0));
            // All paths carry the same flux, so roulette returns exactly what it takes, except for
            // rounding.
            CHECK(relative_error(flux.roulette + flux.emitted, flux.emitted) < 1e-4);
            const double left = std::pow(static_cast<double>(albedo), bounces);
            CHECK(relative_error(flux.truncated, left * flux.emitted) < 1e-3);
            CHECK(vpls.rays == vpls.alive);  // every ray hits a wall
        }
    }
}

TEST_CASE_FIXTURE(Energy, "flux that leaves an open scene counts as escaped") {
    // Half of a light's rays hit an infinite plane. A plane 8 m wide, 0.1 m away, gets all but 0.6 % of
    // that half.
    Scene scene = ground();
    scene.world.set(scene.light, at({0, 0.1F, 0}));
    scene.world.set(scene.light, PointLight{.intensity = 2.0F});
    const VplReport vpls = trace(scene, {.count = 4000, .bounces = 1});
    const EnergyAccount& flux = vpls.flux;
    CHECK(vpls.rays == 4000);
    CHECK(vpls.alive < 2000);
    CHECK(relative_error(flux.emitted, glm::dvec3(8.0 * pi)) < 1e-4);
    CHECK(relative_error(accounted(flux), flux.emitted) < 1e-3);
    // The solid angle of a square of half width a at height h: 4 asin(a² / (a² + h²)).
    const double met = 4.0 * std::asin(16.0 / (16.0 + 0.01)) / (4.0 * pi);
    // 4,000 low-discrepancy points on a sphere: an error of the order of log N / N.
    CHECK(relative_error(flux.escaped, (1.0 - met) * flux.emitted) < 3e-3);
    CHECK(relative_error(flux.absorbed, 0.5 * met * flux.emitted) < 3e-3);
}

TEST_CASE_FIXTURE(Energy, "rays find the colours of textures decoded from sRGB") {
    const auto traced = [&](const Material& material) {
        Scene scene;
        add(scene.world, Transform{}, MeshInstance{square(4.0F, std::make_shared<const Material>(material))});
        add(scene.world, at({0, 0.1F, 0}), PointLight{});
        scene.camera = add(scene.world, looking({0.3F, 3.0F, 1.2F}, {0, 0, 0}), Camera{});
        return trace(scene, {.count = 500, .bounces = 1}).flux;
    };
    Material textured = *diffuse(glm::vec3(1.0F));
    const Image image{.width = 1, .height = 1, .texels = {{188, 188, 188, 255}}};
    textured.base_colour_texture = std::make_shared<const Image>(image);
    const double decoded = std::pow((188.0 / 255.0 + 0.055) / 1.055, 2.4);  // IEC 61966-2-1
    const EnergyAccount expected = traced(*diffuse(glm::vec3(static_cast<float>(decoded))));
    // Colours are stored in half floats: 2^-11.
    CHECK(relative_error(traced(textured).absorbed, expected.absorbed) < 1e-3);
}

TEST_CASE_FIXTURE(Energy, "a light with a range does not light surfaces beyond it") {
    Scene scene = furnace_box(0.5F);
    scene.world.set(scene.light, at({0, 0, 0}));
    scene.world.set(scene.light, PointLight{.range = 0.9F});  // the walls are at least 1 m away
    const EnergyAccount flux = trace(scene, {.count = 300, .bounces = 3}).flux;
    CHECK(relative_error(flux.escaped, flux.emitted) < 1e-4);
}

TEST_CASE_FIXTURE(Energy, "spot and directional lights emit their analytic flux") {
    Scene scene = furnace_box(0.5F);
    scene.world.remove<PointLight>(scene.light);
    SUBCASE("spot") {
        const double inner = 0.3, outer = 0.7;
        scene.world.set(scene.light, SpotLight{.intensity = 6.0F, .inner_cone = 0.3F, .outer_cone = 0.7F});
        // ∫ I dω: 2π (1 - cos inner), plus the square of a linear ramp between the cones.
        const double flux =
            6.0 * 2.0 * pi * ((1.0 - std::cos(inner)) + (std::cos(inner) - std::cos(outer)) / 3.0);
        CHECK(relative_error(trace(scene, {}).flux.emitted, glm::dvec3(flux)) < 1e-4);
    }
    SUBCASE("directional") {
        scene.world.set(scene.light, looking({0, 1, 0}, {0, 0, 0}, {0, 0, 1}));
        scene.world.set(scene.light, DirectionalLight{.illuminance = 6.0F});
        // Straight down onto a box of 2 m × 2 m.
        CHECK(relative_error(trace(scene, {}).flux.emitted, glm::dvec3(24.0)) < 1e-4);
    }
}

TEST_CASE_FIXTURE(Energy, "uneven scenes lose flux only to roulette, within its standard error") {
    for (const std::uint32_t seed : {0U, 1U, 2U}) {
        for (const std::uint32_t count : {64U, 1024U}) {
            for (const bool many_lights : {false, true}) {
                CAPTURE(seed);
                CAPTURE(count);
                CAPTURE(many_lights);
                const Scene scene = many_lights ? open_scene() : cornell_box();
                const EnergyAccount flux = trace(scene, {.count = count, .bounces = 6, .seed = seed}).flux;
                CHECK(relative_error(accounted(flux), flux.emitted) < 1e-3);
                for (int c = 0; c < 3; ++c) {
                    CHECK(std::abs(flux.roulette[c]) <= 4.0 * flux.roulette_error[c]);
                }
            }
        }
    }
}

TEST_CASE_FIXTURE(Energy, "at most the requested number of VPLs is placed, and more than half of it") {
    const Scene scene = cornell_box();
    for (const std::uint32_t count : {0U, 1U, 2U, 3U, 7U, 64U, 255U, 1000U}) {
        for (const std::uint32_t bounces : {0U, 1U, 2U, 64U}) {
            CAPTURE(count);
            CAPTURE(bounces);
            const VplReport vpls = trace(scene, {.count = count, .bounces = bounces});
            if (bounces == 0) CHECK(vpls.alive == 0);
            // Paths that continue can leave the box: up to a third of them through its open front.
            if (bounces > 0 && count >= 64) CHECK(vpls.alive > count / 2);
        }
    }
}

}  // TEST_SUITE("energy")
