// Interleaved gathering gives the same result as gathering all VPLs at every pixel, on continuous surfaces.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "renderer/passes/indirect/vpl_gather.hpp"
#include "tests/renderer/path_fixture.hpp"

TEST_SUITE("interleaved gathering") {

using namespace candela;

namespace {

constexpr std::array interleaved{Interleave::two, Interleave::four, Interleave::eight};

Configuration indirect_only(Interleave interleave, std::uint32_t vpls) {
    Configuration configuration = linear_configuration();
    configuration.show = Show::indirect;
    configuration.vpls = {.placement = VplPlacement::paths, .count = vpls};
    configuration.interleave = interleave;
    return configuration;
}

class VplGatherTests : public PathFixture {
 protected:
    Picture picture(const Scene& scene, const Configuration& configuration, glm::uvec2 size) {
        configure(configuration);
        return render(scene, size);
    }
    std::uint32_t filled_pixels() {
        const Report report = renderer.report();
        REQUIRE(report.vpls);
        return report.vpls->filled_pixels;
    }
};

/// Three lights whose paths have up to four bounces.
PathPlan three_lights() {
    LightTable lights;
    for (std::uint32_t i = 0; i < 3; ++i) {
        const auto flux = static_cast<float>(1U << (2 * i));
        lights.entries.push_back({.entity = {i, 1}, .light = {}, .flux = glm::vec3(flux)});
    }
    return plan_paths(lights, 0.6F, {.count = 1000, .bounces = 4});
}

}  // namespace

TEST_CASE("automatic interleaving leaves eight VPLs per class, and is lower for few VPLs or pixels") {
    for (std::uint32_t count = 0; count < 5000; ++count) {
        const std::uint32_t n = interleaving(Interleave::automatic, count, {512, 512});
        CHECK((n == 1 || n == 2 || n == 4 || n == 8));
        CHECK((n == 1 || count >= 8 * n * n));
        CHECK((n == 8 || count < 8 * 4 * n * n));
    }
    for (std::uint32_t rows = 1; rows < 1000; ++rows) {
        const std::uint32_t n = interleaving(Interleave::automatic, 1U << 20U, {4000, rows});
        CHECK((n == 1 || rows >= 60 * n));
        CHECK((n == 8 || rows < 60 * 2 * n));
    }
    CHECK(interleaving(Interleave::one, 4096, {512, 512}) == 1);
    CHECK(interleaving(Interleave::eight, 1, {1, 1}) == 8);
}

TEST_CASE("each share of the VPLs contains its part of every light and bounce") {
    const PathPlan paths = three_lights();
    std::vector<std::uint32_t> order = order_vpls(paths);
    REQUIRE(order.size() == paths.vpl_count);

    std::map<std::uint32_t, std::pair<std::uint32_t, std::uint32_t>> group_of;  // light and bounce, by VPL
    std::map<std::pair<std::uint32_t, std::uint32_t>, double> sizes;
    for (const gpu::Path& path : paths.paths) {
        for (std::uint32_t bounce = 0; bounce < path.vpl_count; ++bounce) {
            group_of[path.first_vpl + bounce] = {path.light, bounce};
            sizes[{path.light, bounce}] += 1.0;
        }
    }
    CHECK(sizes.size() == 12);
    for (const std::size_t classes : {4U, 16U, 64U}) {
        for (std::size_t share = 0; share < classes; ++share) {
            std::map<std::pair<std::uint32_t, std::uint32_t>, double> found;
            const std::size_t last = (share + 1) * order.size() / classes;
            for (std::size_t i = share * order.size() / classes; i < last; ++i) {
                ++found[group_of[order[i]]];
            }
            for (const auto& entry : sizes) {
                const auto& group = entry.first;
                const double size = entry.second;
                CAPTURE(group.first);
                CAPTURE(group.second);
                // Each end of a share is within one member of each group of its proportional position.
                const double ends =
                    1.0 + 2.0 * size * static_cast<double>(sizes.size()) / static_cast<double>(order.size());
                CHECK(std::abs(found[group] - size / static_cast<double>(classes)) <= ends);
            }
        }
    }
    std::ranges::sort(order);
    std::vector<std::uint32_t> all(order.size());
    std::iota(all.begin(), all.end(), 0U);
    CHECK(order == all);
}

TEST_CASE_FIXTURE(VplGatherTests, "textures of the stages share storage if their lifetimes do not overlap") {
    const Scene scene = cornell_box();
    Configuration configuration = linear_configuration();
    configuration.vpls.count = 256;
    configuration.interleave = Interleave::eight;
    configure(configuration);
    const glm::uvec2 size{64, 48};
    static_cast<void>(render(scene, size));
    // Of the four rgba32f textures gathered irradiance, irradiance along rows, indirect irradiance and
    // radiance, only two are in use at a time.
    CHECK(renderer.report().memory.shared_by_aliasing_bytes == std::uint64_t{2} * size.x * size.y * 16);
}

TEST_CASE_FIXTURE(VplGatherTests, "on a plane the result equals that of all VPLs, up to rounding") {
    // A view so narrow that the light of a VPL is the same in the whole picture.
    Scene scene = cornell_box();
    scene.camera =
        add(scene.world, looking({0.1F, 1.3F, 1.0F}, {0.15F, 1.25F, -1.0F}), Camera{.vertical_fov = 1e-4F});
    for (const VplVisibility method : {VplVisibility::none, VplVisibility::rays}) {
        // The number of VPLs is not a multiple of the number of classes, and the picture is not a whole
        // number of blocks.
        Configuration configuration = indirect_only(Interleave::one, 300);
        configuration.visibility.method = method;
        const Picture all = picture(scene, configuration, {83, 61});
        CHECK(mean(all) > 0.01);
        for (const Interleave interleave : interleaved) {
            CAPTURE(to_string(interleave));
            configuration.interleave = interleave;
            // Over 0.1 mm, the light of the nearest VPL, 0.5 m away, changes by 1e-4.
            CHECK(worst_error(picture(scene, configuration, {83, 61}), all, 1e-12) < 2e-4);
            CHECK(filled_pixels() == 0);
        }
    }
}

TEST_CASE_FIXTURE(VplGatherTests, "light does not leak from one surface to another") {
    // The wall at the back is lit, and does not light surfaces that face away from it.
    Scene scene;
    const glm::quat towards_z = glm::angleAxis(glm::half_pi<float>(), glm::vec3(1, 0, 0));
    add(scene.world, Transform{.translation = {0, 0, -1}, .rotation = towards_z},
        MeshInstance{square(4.0F, diffuse(glm::vec3(0.8F)))});
    for (int i = 0; i < 7; ++i) {
        const float x = 0.25F * static_cast<float>(i - 3);
        add(scene.world,
            Transform{.translation = {x, 0.1F * x, 0.1F * static_cast<float>(i)},
                      .rotation = towards_z,
                      .scale = glm::vec3(0.1F)},
            MeshInstance{square(1.0F, diffuse(glm::vec3(0.5F)))});
    }
    add(scene.world, at({0, 0, 0.8F}), PointLight{.intensity = 10.0F});
    scene.camera = add(scene.world, at({0, 0, 3}), Camera{.vertical_fov = 0.8F});
    // One bounce: all VPLs face the viewer, as do all visible surfaces.
    Configuration configuration = indirect_only(Interleave::one, 256);
    configuration.vpls.bounces = 1;
    configuration.visibility.method = VplVisibility::rays;
    const Picture all = picture(scene, configuration, {96, 72});
    const auto black = std::ranges::count(all.pixels, glm::vec3(0.0F));
    for (const Interleave interleave : interleaved) {
        CAPTURE(to_string(interleave));
        configuration.interleave = interleave;
        const Picture shared = picture(scene, configuration, {96, 72});
        for (std::size_t i = 0; i < all.pixels.size(); ++i) {
            CHECK((all.pixels[i] != glm::vec3(0.0F) || shared.pixels[i] == glm::vec3(0.0F)));
        }
    }
    CHECK(black > 1000);
}

TEST_CASE_FIXTURE(VplGatherTests, "in the Cornell box it differs by less than the VPLs' own noise") {
    const Scene scene = cornell_box();
    Configuration configuration = indirect_only(Interleave::one, 1024);
    configuration.visibility = {.method = VplVisibility::maps, .map_resolution = 16};
    constexpr glm::uvec2 size{160, 120};
    const Picture all = picture(scene, configuration, size);
    configuration.vpls.seed = 1;
    const double noise =
        0.5 * relative_mean_square(picture(scene, configuration, size), all);  // of each seed
    configuration.vpls.seed = 0;
    for (const Interleave interleave : interleaved) {
        CAPTURE(to_string(interleave));
        configuration.interleave = interleave;
        const Picture shared = picture(scene, configuration, size);
        CHECK(is_sane(shared));
        CHECK(shared != all);
        CHECK(relative_mean_square(shared, all) < noise);
        CHECK(mean(shared) == doctest::Approx(mean(all)).epsilon(0.01));
    }
}

TEST_CASE_FIXTURE(VplGatherTests, "pixels without suitable neighbours gather VPLs themselves") {
    Scene scene = cluttered_room();
    add(scene.world, at({0.5F, 1.0F, 0.5F}), PointLight{.intensity = 5.0F});
    constexpr glm::uvec2 size{96, 72};
    const Picture all = picture(scene, indirect_only(Interleave::one, 256), size);
    const Picture shared = picture(scene, indirect_only(Interleave::four, 256), size);
    CHECK(filled_pixels() > 50);
    CHECK(filled_pixels() < 96 * 72 / 2);
    CHECK(is_sane(shared));
    CHECK(mean(shared) == doctest::Approx(mean(all)).epsilon(0.02));
}

TEST_CASE_FIXTURE(VplGatherTests, "pictures of one pixel, one row and one column are correct") {
    const Scene scene = cornell_box();
    for (const glm::uvec2 size : {glm::uvec2(1, 1), glm::uvec2(37, 1), glm::uvec2(1, 37)}) {
        const Picture all = picture(scene, indirect_only(Interleave::one, 256), size);
        const Picture shared = picture(scene, indirect_only(Interleave::eight, 256), size);
        CHECK(is_sane(shared));
        // Half of the VPLs, or 8 of 64 shares in a row, represent all of them.
        CHECK(mean(shared) == doctest::Approx(mean(all)).epsilon(0.25));
    }
}

TEST_CASE_FIXTURE(VplGatherTests, "without lights there is no indirect light") {
    Scene scene = cluttered_room();
    const Picture dark = picture(scene, indirect_only(Interleave::four, 256), {32, 24});
    CHECK(mean(dark) == 0.0);
}

}  // TEST_SUITE("interleaved gathering")
