#include <doctest/doctest.h>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "tests/reference/pictures.hpp"
#include "tests/renderer/path_fixture.hpp"
#include "tests/study/measures.hpp"

TEST_SUITE("reference: the renderer's direct light") {

using namespace candela;

namespace {

// A pixel is the mean of this many samples along each side. At a shadow edge a single sample is all or
// nothing, in either picture, and in a mostly black picture one pixel on the wrong side would dominate the
// error.
constexpr int samples_across = 4;
// An even width and an odd height: the edges of rooms run along the diagonals of their pictures and would
// otherwise pass through pixel centres, where rounding decides which of two walls is seen.
constexpr glm::uvec2 sampled_size{320, 239};

/// relMSE of the renderer's direct light.
struct DirectErrors {
    double samples;  ///< per sample, away from edges
    double pixels;   ///< per pixel, everywhere
};

class DirectLight : public PathFixture {
 protected:
    DirectErrors errors(const Scene& scene, const reference::Estimate& truth, std::uint32_t resolution) {
        Configuration configuration = linear_configuration();
        configuration.show = Show::direct;
        configuration.shadows = {
            .cube_resolution = resolution, .map_resolution = resolution, .budget_mib = 1024};
        configure(configuration);
        renderer.invalidate();
        const tools::Picture picture = reference::flipped(render(scene, sampled_size));
        CHECK(renderer.report().lights.without_map == 0);
        const std::vector<std::uint8_t> away = reference::without(truth.hit, truth.edge);
        return {study::measure(picture, truth.direct, away).rel_mse,
                study::measure(study::scaled_down(picture, samples_across),
                               study::scaled_down(truth.direct, samples_across))
                    .rel_mse};
    }

    /// Adds a box from `lower` to `upper`.
    static void add_box(World& world, glm::vec3 lower, glm::vec3 upper) {
        Transform pose = at((lower + upper) * 0.5F);
        pose.scale = (upper - lower) * 0.5F;
        add(world, pose, MeshInstance{box_inwards(1.0F, diffuse(glm::vec3(0.5F), true))});
    }

    /// Ground of this half width, lit by a sun or by a lamp, and a camera `away` from the origin.
    static Scene lit_ground(float half, bool sun, glm::vec3 away) {
        Scene scene;
        add(scene.world, Transform{}, MeshInstance{square(half, diffuse(glm::vec3(0.7F)))});
        scene.camera = add(scene.world, looking(away, {0.0F, 0.4F, 0.0F}), Camera{});
        const Transform light = looking({3.0F, 4.0F, 2.2F}, {0.0F, 0.0F, 0.0F});
        if (sun) {
            add(scene.world, light, DirectionalLight{.illuminance = 3.0F});
        } else {
            add(scene.world, light, PointLight{.intensity = 60.0F});
        }
        return scene;
    }

    /// The required bounds must hold at every resolution of the shadow maps. Rays decide wherever an edge may
    /// be near, so the error must not depend on the resolution either: by less than a hundredth, which is
    /// left for pixels on edges.
    void check_scene(const Scene& scene, const std::vector<std::uint32_t>& resolutions) {
        const reference::Estimate truth = trace(reference::Scene(scene.world), scene.camera,
                                                {.size = sampled_size, .samples = 2, .bounces = 0});
        std::optional<double> first;
        for (const std::uint32_t resolution : resolutions) {
            CAPTURE(resolution);
            const DirectErrors found = errors(scene, truth, resolution);
            MESSAGE("relMSE of samples ", found.samples, ", of pixels ", found.pixels);
            CHECK(found.samples <= 1e-4);
            CHECK(found.pixels <= 1e-3);
            CHECK(std::abs(found.pixels - first.value_or(found.pixels)) <= 0.01 * found.pixels + rounding);
            first = first.value_or(found.pixels);
        }
    }

    /// Albedos are half floats with an error of 2⁻¹¹; this is its square.
    static constexpr double rounding = 2.4e-7;
};

}  // namespace

TEST_CASE_FIXTURE(DirectLight, "boxes and rooms") {
    for (const std::string name : {"cornell", "corner", "two-rooms", "furnace"}) {
        CAPTURE(name);
        check_scene(shipped_scene(name), {256, 512, 1024});
    }
}

TEST_CASE_FIXTURE(DirectLight, "blended and masked surfaces") {
    check_scene(shipped_scene("glass"), {128, 256, 512});
}

TEST_CASE_FIXTURE(DirectLight, "many lights in a hall") {
    check_scene(shipped_scene("hall-256"), {128, 256});
}

TEST_CASE_FIXTURE(DirectLight, "poles, however thin they are and however large the ground") {
    // On the larger ground, a texel of the sun's map is 1 m wide and more.
    for (const float half : {6.0F, 500.0F}) {
        for (const bool sun : {true, false}) {
            CAPTURE(half);
            CAPTURE(sun);
            Scene scene = lit_ground(half, sun, {0.5F, 2.0F, 2.5F});
            float x = -1.2F;
            for (const float width : {0.002F, 0.005F, 0.01F, 0.03F, 0.1F, 0.3F}) {
                add_box(scene.world, {x, 0.0F, -0.3F}, {x + width, 1.2F, width - 0.3F});
                x += 0.4F;
            }
            check_scene(scene, {512, 1024});
        }
    }
}

TEST_CASE_FIXTURE(DirectLight, "the eaves of a house on a plot and on a plain") {
    for (const float half : {20.0F, 500.0F}) {
        CAPTURE(half);
        Scene scene = lit_ground(half, true, {9.0F, 3.0F, 9.0F});
        add_box(scene.world, {-4.0F, 0.0F, -4.0F}, {4.0F, 2.8F, 4.0F});
        add_box(scene.world, {-4.5F, 2.8F, -4.5F}, {4.5F, 3.0F, 4.5F});
        check_scene(scene, {512, 1024});
    }
}

TEST_CASE_FIXTURE(DirectLight, "a slit that is narrower than a texel") {
    Scene scene = lit_ground(500.0F, true, {0.3F, 1.5F, 2.0F});
    add_box(scene.world, {-3.0F, 1.8F, -3.0F}, {0.49F, 1.9F, 3.0F});
    add_box(scene.world, {0.51F, 1.8F, -3.0F}, {3.0F, 1.9F, 3.0F});
    check_scene(scene, {512, 1024});
}

TEST_CASE_FIXTURE(DirectLight, "thin fins") {
    Scene scene = shipped_scene("fins");
    std::vector<Entity> lights;
    for (auto [entity, light] : scene.world.view<PointLight>()) lights.push_back(entity);
    // Every eighth of the 512 lights: the shadow maps of all would take longer than all other tests.
    for (std::size_t i = 0; i < lights.size(); ++i) {
        if (i % 8 != 0) scene.world.destroy(lights[i]);
    }
    check_scene(scene, {128, 256});
}

}  // TEST_SUITE("reference: the renderer's direct light")
