#include <doctest/doctest.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <tuple>
#include <vector>

#include "renderer/passes/lights/light_table.hpp"
#include "renderer/passes/vpls/vpl_paths.hpp"
#include "tests/renderer/path_fixture.hpp"

TEST_SUITE("changes") {

using namespace candela;

namespace {

constexpr glm::uvec2 size{24, 18};

}  // namespace

TEST_CASE_FIXTURE(RenderFixture, "another world in the place of the last one is another world") {
    Configuration configuration = linear_configuration();
    configuration.visibility = {.method = VplVisibility::maps, .map_resolution = 16};
    configuration.refinement.enabled = true;
    for (const VplPlacement placement : {VplPlacement::surfels, VplPlacement::paths}) {
        configuration.vpls = {.placement = placement, .count = 8};
        configure(configuration);
        // Built by the same changes, so that they have been changed equally often.
        const auto made = [](float height, glm::vec3 albedo) {
            Scene scene = ground();
            scene.world.set(scene.light, at({0.0F, height, 0.0F}));
            scene.world.set(scene.light, PointLight{});
            add(scene.world, at({0.2F, 0.3F, 0.0F}), MeshInstance{square(0.2F, diffuse(albedo, true))});
            return scene;
        };
        Scene scene = made(1.0F, {0.9F, 0.1F, 0.1F});
        static_cast<void>(render(scene, size));
        for (const float height : {0.6F, 1.5F, 1.0F}) {
            scene = made(height, {0.1F, 0.1F, height / 2.0F});
            CHECK(render(scene, size) == from_scratch(scene, size));
        }
    }
}

TEST_CASE_FIXTURE(RenderFixture, "another seed gives other VPLs, the same seed gives the same ones") {
    const Scene scene = cornell_box();
    Configuration configuration = linear_configuration();
    configure(configuration);
    const Picture first = render(scene, size);
    configuration.vpls.seed = 1;
    configure(configuration);
    CHECK(render(scene, size) != first);
    configuration.vpls.seed = 0;
    configure(configuration);
    CHECK(render(scene, size) == first);
}

TEST_CASE("most VPL paths stay the same while lights move and change a little") {
    LightTable lights;
    for (std::uint32_t i = 0; i < 5; ++i) {
        lights.entries.push_back(
            {.entity = {i, 1}, .light = {}, .flux = glm::vec3(1.0F + static_cast<float>(i))});
    }
    const VplSettings settings{.count = 1000, .bounces = 4};
    const PathPlan before = plan_paths(lights, 0.6F, settings);
    lights.entries[2].light.position = {1, 2, 3};
    CHECK(plan_paths(lights, 0.6F, settings) == before);

    // A light that is 1 % brighter takes one or two paths from the others. The points of their sequences
    // stay.
    lights.entries[2].flux *= 1.01F;
    const auto points_of = [](const PathPlan& plan) {
        std::set<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>> points;
        for (const gpu::Path& path : plan.paths) points.insert({path.light, path.index, path.seed});
        return points;
    };
    const auto old_points = points_of(before);
    const auto new_points = points_of(plan_paths(lights, 0.6F, settings));
    std::vector<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>> common;
    std::ranges::set_intersection(old_points, new_points, std::back_inserter(common));
    CHECK(common.size() * 100 >= old_points.size() * 98);
}

}  // TEST_SUITE("changes")
