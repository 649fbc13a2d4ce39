// Surfels are where the light comes from that is seen.

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <deque>
#include <vector>

#include "renderer/facade/device_of.hpp"
#include "renderer/gpu/gpu_types.hpp"
#include "tests/renderer/path_fixture.hpp"
#include "tests/renderer/scene_builder.hpp"
#include "tests/seed.hpp"

TEST_SUITE("surfels: guide") {

using namespace candela;

namespace {

constexpr glm::uvec2 size{24, 16};
constexpr float apart = 4.0F;  // metres, of the middles of two rooms

/// Two closed rooms of the same size, each with a lamp of its own. The camera is in the one at the origin.
Scene closed_rooms() {
    Scene scene = furnace_box(0.5F);
    add(scene.world, at({apart, 0.0F, 0.0F}), MeshInstance{box_inwards(1.0F, diffuse(glm::vec3(0.5F)))});
    add(scene.world, at({apart, 0.3F, 0.0F}), PointLight{});
    return scene;
}

class GuideTests : public RenderFixture {
 protected:
    GuideTests() {
        configuration_.show = Show::indirect;
        configuration_.vpls = {.placement = VplPlacement::surfels, .count = 256, .seed = test_seed()};
        configuration_.vpls.guided = true;
        configuration_.visibility.method = VplVisibility::none;
    }

    std::vector<gpu::LitSurfel> surfels_of(const Scene& scene) { return surfels_of(scene, {scene.camera}); }

    /// With a view for each camera.
    std::vector<gpu::LitSurfel> surfels_of(const Scene& scene, const std::vector<Entity>& cameras) {
        std::vector<RenderView> views;
        while (targets_.size() < cameras.size()) targets_.emplace_back(device, size);
        for (std::size_t i = 0; i < cameras.size(); ++i) {
            views.push_back({.camera = cameras[i], .target = targets_[i].target(), .keep = {.vpls = true}});
        }
        renderer.render(scene.world, views);
        const ResultBuffer result = renderer.results().lit_surfels;
        std::vector<gpu::LitSurfel> surfels(result.count);
        device.gl().GetNamedBufferSubData(result.buffer, 0,
                                          static_cast<GLsizeiptr>(surfels.size() * sizeof(gpu::LitSurfel)),
                                          surfels.data());
        return surfels;
    }

    Configuration configuration_ = linear_configuration();

 private:
    std::deque<RenderTarget> targets_;
};

/// Share of the surfels of which `holds` is true.
template <class Holds>
double share_of(const std::vector<gpu::LitSurfel>& surfels, const Holds& holds) {
    return static_cast<double>(std::ranges::count_if(surfels, holds)) / static_cast<double>(surfels.size());
}

}  // namespace

TEST_CASE_FIXTURE(GuideTests,
                  "a room that nothing is seen of, and that lights nothing seen, has few surfels") {
    configure(configuration_);
    const auto is_elsewhere = [](const gpu::LitSurfel& surfel) { return surfel.position.x > 0.5F * apart; };
    // By area alone it would be half. Light counts 1 and area 0.2, of which half is there: 0.1 / 1.2 = 0.083.
    // Cells are not equally worth, within a factor of 2, so that there are more or fewer.
    const double share = share_of(surfels_of(closed_rooms()), is_elsewhere);
    CHECK(share < 2.0 * 0.083);
    CHECK(share > 0.5 * 0.083);
}

TEST_CASE_FIXTURE(GuideTests,
                  "a room that fills four times as much of the pictures has twice as many surfels") {
    // The relMSE of a room of n pixels and s surfels, whose errors are independent, is about n / s; of both
    // rooms together it is least if s is as the root of n.
    Scene scene = closed_rooms();
    const Entity other =
        add(scene.world, looking({apart, 0, 0.9F}, {apart, 0, 0}), Camera{.vertical_fov = 1.5F});
    configure(configuration_);
    const auto surfels = surfels_of(scene, {scene.camera, scene.camera, scene.camera, scene.camera, other});
    const auto is_first = [](const gpu::LitSurfel& surfel) { return surfel.position.x < 0.5F * apart; };
    // Light counts 1 and area 0.2, of which half is there: (2 / 3 + 0.1) / 1.2. In proportion to n it would
    // be 0.75. The rooms are alike, so that the worth of their cells varies alike.
    CHECK(share_of(surfels, is_first) == doctest::Approx(0.639).epsilon(0.03));
}

TEST_CASE_FIXTURE(GuideTests, "what is brighter has more surfels, in proportion to what it sends") {
    Scene scene = furnace_box(0.5F);
    // A spot that lights the middle of the ceiling: nearly all light of the first bounce comes from there.
    scene.world.remove<PointLight>(scene.light);
    scene.world.set(scene.light, looking({0.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F}, {0, 0, 1}));
    scene.world.set(scene.light, SpotLight{.inner_cone = 0.3F, .outer_cone = 0.35F});
    configure(configuration_);
    // The lit disc has a radius of tan 0.35 = 0.365 m, and thus 0.42 of the 24 m² in all.
    const auto is_lit = [](const gpu::LitSurfel& surfel) {
        return surfel.position.y > 0.99F &&
               glm::length(glm::vec2(surfel.position.x, surfel.position.z)) < 0.4F;
    };
    // With albedo 0.5, the first reflection is half of all that surfaces of a closed room reflect, and thus
    // half of what lights five of the six sides; the ceiling does not see the disc. Light counts 1 of 1.2:
    // 0.35. The worth of cells varies by a factor of 2, so that there are more or fewer.
    const double share = share_of(surfels_of(scene), is_lit);
    CHECK(share > 0.25);
    CHECK(share < 0.65);
}

TEST_CASE_FIXTURE(GuideTests,
                  "where surfels wait for their turn, the guide stays while a light moves, not longer") {
    Scene scene = furnace_box(0.5F);
    configuration_.vpls.updates = 32;
    configure(configuration_);
    static_cast<void>(settled_picture(scene, size));
    scene.world.set(scene.light, at({-0.5F, -0.4F, 0.3F}));
    static_cast<void>(render(scene, size));
    CHECK_FALSE(ran("surfel-guide (guide)"));
    CHECK_FALSE(ran("surfel-light (guide)"));
    CHECK_FALSE(renderer.settled());
    static_cast<void>(render(scene, size));
    CHECK(ran("surfel-guide (guide)"));
    CHECK(settled_picture(scene, size).pixels == fresh_picture(scene, size).pixels);
}

TEST_CASE_FIXTURE(GuideTests, "a light that moves for long does not keep the guide") {
    Scene scene = furnace_box(0.5F);
    configuration_.vpls.updates = 64;
    configure(configuration_);
    static_cast<void>(settled_picture(scene, size));
    int runs = 0;
    for (int i = 1; i <= 36; ++i) {
        scene.world.set(scene.light, at({0.02F * static_cast<float>(i), 0.0F, 0.0F}));
        static_cast<void>(render(scene, size));
        if (ran("surfel-guide (guide)")) ++runs;
    }
    // Every 8th frame, or later, once surfels are placed by the last one: 64 of 512 are traced in a frame.
    CHECK(runs >= 2);
    CHECK(runs <= 4);
}

}  // TEST_SUITE("surfels: guide")
