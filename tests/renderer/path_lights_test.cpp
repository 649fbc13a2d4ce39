#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "tests/renderer/path_fixture.hpp"

using namespace candela;

namespace {

constexpr glm::uvec2 size{80, 50};

void add_point(World& world, glm::vec3 position, float range) {
    add(world, at(position), PointLight{.range = range});
}

}  // namespace

// Each case has only the lights that it tests, so that a list that misses one is noticed.
TEST_SUITE("paths: lights") {
    TEST_CASE_FIXTURE(PathFixture,
                      "lights around and behind the camera, and across the planes of the view frustum") {
        struct Case {
            std::string name;
            Camera camera;
            std::function<void(World&)> add_lights;
        };
        constexpr glm::vec3 forwards{0, 0, -1};
        const std::vector<Case> cases = {
            {"around the eye",
             {},
             [](World& world) {
                 add_point(world, eye, 2.0F);
                 add_point(world, eye + glm::vec3(0.1F, -0.05F, 0.02F), 1.0F);
             }},
            {"behind the eye",
             {},
             [&](World& world) {
                 add_point(world, eye - 0.3F * forwards, 1.2F);
                 add_point(world, eye - 0.4F * forwards, 0.3F);  // does not reach visible surfaces
             }},
            {"beside the view, reaching into it",
             {},
             [](World& world) {
                 add_point(world, {1.9F, 0.0F, 1.4F}, 1.5F);
                 add_point(world, {0.0F, -1.9F, 1.6F}, 2.0F);
             }},
            {"across the near plane",
             {.near_plane = 0.5F},
             [&](World& world) {
                 add_point(world, eye + 0.5F * forwards, 0.4F);
                 add_point(world, eye + 0.3F * forwards, 0.5F);
                 add_point(world, eye + 0.8F * forwards, 0.35F);
             }},
            {"beyond the far plane",
             {.far_plane = 2.0F},
             [&](World& world) {
                 add_point(world, eye + 2.2F * forwards, 1.0F);
                 add_point(world, eye + 3.4F * forwards, 2.0F);
             }},
            {"reaching across the whole world",
             {},
             [](World& world) {
                 add_point(world, {0, 1, 0}, 1e6F);
             }},
        };
        for (const Case& each : cases) {
            CAPTURE(each.name);
            Scene scene = cluttered_room();
            scene.world.set(scene.camera, each.camera);
            each.add_lights(scene.world);
            check_paths(scene, size, direct_only());
        }
    }

    TEST_CASE_FIXTURE(PathFixture, "a light with a range of one millimetre") {
        Scene scene;
        add(scene.world, Transform{}, MeshInstance{square(4.0F, diffuse(glm::vec3(0.5F)))});
        scene.camera = add(scene.world, looking({1.0F, 0.004F, 1.0F}, {1.0F, 0.0F, 1.0F}, {0, 0, -1}),
                           Camera{.near_plane = 1e-4F});
        add_point(scene.world, {1.0005F, 0.0005F, 1.0F}, 1e-3F);
        check_paths(scene, size, direct_only());
    }

    TEST_CASE_FIXTURE(PathFixture, "ten thousand lights in one tile") {
        constexpr int count = 10'000;
        Scene scene = cluttered_room();
        for (int i = 0; i < count; ++i) {
            const auto step = static_cast<float>(i);
            const glm::vec3 spread(std::fmod(0.618F * step, 1.0F), std::fmod(0.382F * step, 1.0F),
                                   std::fmod(0.755F * step, 1.0F));
            add_point(scene.world, glm::vec3(-1.6F, -1.0F, -1.95F) + 0.2F * spread, 0.15F);
        }
        // One of 3 × 2 tiles sees the corner of the room where the lights are.
        check_paths(scene, {33, 17}, direct_only());
        const LightReport lights = renderer.report().lights;
        CHECK(lights.global == 0);
        CHECK(lights.tile_max == count);
    }

    TEST_CASE_FIXTURE(PathFixture, "a camera inside a wall, and in the plane of one") {
        Scene scene = cluttered_room();
        add_ranged_lights(scene.world, 30, 0.8F);
        const auto wall = box_inwards(1.0F, diffuse({0.5F, 0.7F, 0.5F}, true));
        const Entity slab =
            add(scene.world, Transform{.translation = eye, .scale = {3.0F, 3.0F, 0.1F}}, MeshInstance{wall});
        add_point(scene.world, eye + glm::vec3(0.2F, 0.3F, 0.05F), 0.4F);
        check_paths(scene, size, direct_only());

        scene.world.set(
            slab, Transform{.translation = eye + glm::vec3(0.0F, -0.1F, 0.0F), .scale = {0.5F, 0.1F, 0.5F}});
        check_paths(scene, size, direct_only());
    }

    TEST_CASE_FIXTURE(PathFixture, "ranged lights seen by an orthographic camera") {
        Scene scene = cluttered_room();
        add_ranged_lights(scene.world, 40, 0.8F);
        add_point(scene.world, eye + glm::vec3(0.0F, 0.0F, 0.4F), 1.0F);
        const auto camera = [](float near_plane, float far_plane) {
            return Camera{.projection = Camera::Projection::orthographic,
                          .half_height = 1.2F,
                          .near_plane = near_plane,
                          .far_plane = far_plane};
        };
        for (const Camera& each : {camera(0.0F, 10.0F), camera(1.0F, 2.5F)}) {
            CAPTURE(each.far_plane);
            scene.world.set(scene.camera, each);
            check_paths(scene, size, direct_only());
        }
    }

    TEST_CASE_FIXTURE(PathFixture, "narrow and wide spot lights") {
        constexpr float pi = std::numbers::pi_v<float>;
        Scene scene = cluttered_room();
        std::mt19937 engine(5);
        std::uniform_real_distribution<float> number(-1.5F, 1.5F);
        const auto place = [&] {
            const float x = number(engine), y = number(engine);
            return glm::vec3(x, y, number(engine));
        };
        for (const float outer : {0.02F, 0.1F, 0.5F, pi / 4.0F, 0.8F, 1.3F, pi / 2.0F}) {
            for (const float inner : {0.0F, 0.99F * outer}) {
                for (const float range : {0.5F, 3.0F, 1e6F}) {
                    const glm::vec3 from = place();
                    add(scene.world, looking(from, place()),
                        SpotLight{
                            .intensity = 0.5F, .range = range, .inner_cone = inner, .outer_cone = outer});
                }
            }
        }
        check_paths(scene, size, direct_only());
        check_paths(scene, {41, 90}, direct_only());
    }
}
