#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "tests/renderer/scene_builder.hpp"

using namespace candela;

namespace {

/// The Cornell box with `count` lights: its own, then spot, directional and point lights of all colours in
/// turn, at fixed places distributed by the golden ratio.
Scene cornell_box_with_lights(int count) {
    Scene scene = cornell_box();
    const auto spread = [](int i, float step) { return std::fmod(static_cast<float>(i) * step, 1.0F); };
    for (int i = 1; i < count; ++i) {
        const glm::vec3 position(1.6F * spread(i, 0.618F) - 0.8F, 0.2F + 1.6F * spread(i, 0.382F),
                                 1.6F * spread(i, 0.755F) - 0.8F);
        const glm::vec3 colour(spread(i, 0.57F), spread(i, 0.31F), spread(i, 0.83F));
        const float strength = 4.0F / static_cast<float>(count);
        const Transform pose = looking(position, {0.1F, 0.9F, 0.05F});
        switch (i % 3) {
            case 0:
                add(scene.world, pose, PointLight{.colour = colour, .intensity = strength, .range = 1.5F});
                break;
            case 1:
                add(scene.world, pose,
                    SpotLight{
                        .colour = colour, .intensity = strength, .inner_cone = 0.2F, .outer_cone = 0.6F});
                break;
            default:
                add(scene.world, pose, DirectionalLight{.colour = colour, .illuminance = strength});
                break;
        }
    }
    return scene;
}

}  // namespace

TEST_SUITE("shading paths") {
    TEST_CASE_FIXTURE(RenderFixture, "all paths agree at every pixel") {
        for (const int lights : {1, 7, 64}) {
            // Whole tiles, and tiles that are cut by the edges of the picture.
            for (const glm::uvec2 size : {glm::uvec2(128, 128), glm::uvec2(109, 71)}) {
                CAPTURE(lights);
                CAPTURE(size.x);
                const Scene scene = cornell_box_with_lights(lights);
                renderer.invalidate();
                Picture first;
                for (const ShadingPath path : all_shading_paths) {
                    CAPTURE(to_string(path));
                    Configuration configuration = linear_configuration(path);
                    configuration.shadows = {.cube_resolution = 128, .map_resolution = 128};
                    configure(configuration);
                    const Picture picture = render(scene, size);
                    if (first.pixels.empty()) first = picture;
                    CHECK(renderer.report().lights.without_shadow == 0);
                    CHECK(is_sane(picture));
                    CHECK(mean(picture) > 0.01);
                    // All paths shade the same numbers. Only the order in which compilers add and multiply
                    // differs.
                    CHECK(worst_error(picture, first, 1e-4) < 1e-3);
                }
            }
        }
    }

    TEST_CASE_FIXTURE(RenderFixture, "all paths agree on surfels after a light has moved") {
        Picture first;
        for (const ShadingPath path : all_shading_paths) {
            CAPTURE(to_string(path));
            Configuration configuration = linear_configuration(path);
            configuration.vpls = {.placement = VplPlacement::surfels, .count = 64};
            configuration.visibility = {.method = VplVisibility::maps, .map_resolution = 16};
            configuration.shadows = {.cube_resolution = 128, .map_resolution = 128};
            configure(configuration);
            Scene scene = cornell_box_with_lights(7);
            static_cast<void>(render(scene, {160, 120}));
            scene.world.edit<Transform>(scene.light,
                                        [](Transform& t) { t.translation += glm::vec3(0.1F, -0.1F, 0); });
            const Picture picture = render(scene, {160, 120});
            if (first.pixels.empty()) first = picture;
            CHECK(is_sane(picture));
            CHECK(worst_error(picture, first, 1e-4) < 1e-3);  // as above
        }
    }

    TEST_CASE_FIXTURE(RenderFixture, "direct and indirect light add up to the total") {
        const Scene scene = cornell_box_with_lights(7);
        for (const ShadingPath path : {ShadingPath::forward, ShadingPath::deferred}) {
            std::array<Picture, 3> pictures;
            for (const Show show : {Show::total, Show::direct, Show::indirect}) {
                Configuration configuration = linear_configuration(path);
                configuration.show = show;
                configure(configuration);
                pictures[static_cast<std::size_t>(show)] = render(scene, {60, 40});
                CHECK(mean(pictures[static_cast<std::size_t>(show)]) > 0.005);
            }
            Picture& sum = pictures[1];
            for (std::size_t i = 0; i < sum.pixels.size(); ++i) {
                sum.pixels[i] += pictures[2].pixels[i];
            }
            // Sums of a few hundred floats in another order.
            CHECK(worst_error(sum, pictures[0], 1e-4) < 1e-4);
        }
    }

    TEST_CASE_FIXTURE(RenderFixture, "if indirect light is disabled, the picture is the direct light") {
        const Scene scene = cornell_box_with_lights(3);
        Configuration configuration = linear_configuration();
        configuration.show = Show::direct;
        configure(configuration);
        const Picture direct = render(scene, {60, 40});
        configuration.show = Show::total;
        configuration.indirect = false;
        configure(configuration);
        CHECK(render(scene, {60, 40}) == direct);
        CHECK_FALSE(renderer.report().vpls);
    }
}
