#include "sandbox/editing/viewer.hpp"

#include <GLFW/glfw3.h>

#include <array>
#include <cmath>

#include <doctest/doctest.h>
#include <glm/gtc/constants.hpp>

#include "tests/sandbox/editing_scene.hpp"

namespace candela::sandbox {

TEST_SUITE("viewer") {

namespace {

// A few roundings of floats of magnitude 10.
constexpr float rounding = 1e-5F;

/// A cube with half a diagonal of 2 metres.
void add_cube(World& world) {
    add_mesh(world, cube(2.0F / std::sqrt(3.0F)));
}

std::array<float, 4> extremes(const World& world, const Viewer& viewer, glm::vec2 size,
                              const Bounds& sphere) {
    const Viewport viewport = make_viewport(world, viewer.entity(), size);
    std::array<float, 4> found{1e9F, -1e9F, 1e9F, -1e9F};
    for (int i = 0; i < 64; ++i) {
        for (int j = 0; j < 64; ++j) {
            const float theta = glm::pi<float>() * static_cast<float>(i) / 63.0F;
            const float phi = glm::two_pi<float>() * static_cast<float>(j) / 64.0F;
            const glm::vec3 off(std::sin(theta) * std::cos(phi), std::cos(theta),
                                std::sin(theta) * std::sin(phi));
            const glm::vec2 at = project(viewport, sphere.centre + sphere.radius * off).value() / size;
            found = {std::min(found[0], at.x), std::max(found[1], at.x), std::min(found[2], at.y),
                     std::max(found[3], at.y)};
        }
    }
    return found;
}

}  // namespace

TEST_CASE("flying moves by speed times time, along the view") {
    World world;
    add_cube(world);
    Viewer viewer(world, add_eye(world, {0, 0, 5}));
    viewer.flying().press(GLFW_KEY_W);
    CHECK(viewer.moving());
    // Half a radius a second, which is 1 m/s.
    for (int i = 0; i < 10; ++i) viewer.step(0.05F);
    CHECK(glm::distance(viewer.orbit().eye, {0, 0, 4.5F}) < rounding);
    viewer.flying().press(GLFW_KEY_LEFT_SHIFT);
    viewer.step(0.05F);
    CHECK(glm::distance(viewer.orbit().eye, {0, 0, 4.3F}) < rounding);
    viewer.flying().release(GLFW_KEY_LEFT_SHIFT);
    viewer.flying().press(GLFW_KEY_D);  // as fast obliquely
    viewer.step(0.1F);
    const float part = 0.1F / std::sqrt(2.0F);
    CHECK(glm::distance(viewer.orbit().eye, {part, 0, 4.3F - part}) < rounding);
    viewer.flying().stop();
    CHECK_FALSE(viewer.moving());
    viewer.step(0.1F);
    CHECK(glm::distance(viewer.orbit().eye, {part, 0, 4.3F - part}) < rounding);
    CHECK(glm::distance(glm::vec3(world.get<Transform>(viewer.entity()).translation), viewer.orbit().eye) ==
          0.0F);
}

TEST_CASE("opposite keys cancel, a pause is no leap, and the wheel changes the speed within limits") {
    World world;
    add_cube(world);
    Viewer viewer(world, add_eye(world, {0, 0, 5}));
    viewer.flying().press(GLFW_KEY_Q);
    viewer.flying().press(GLFW_KEY_E);
    CHECK_FALSE(viewer.moving());
    viewer.flying().release(GLFW_KEY_Q);
    viewer.step(60.0F);
    CHECK(glm::distance(viewer.orbit().eye, {0, 0.1F, 5}) < rounding);
    viewer.flying().adjust_speed(2.0F);
    viewer.step(0.1F);
    CHECK(glm::distance(viewer.orbit().eye, {0, 0.1F + 0.144F, 5}) < rounding);
    viewer.flying().adjust_speed(1e6F);
    CHECK(std::isfinite(viewer.flying().motion(1.0F, 1.0F).y));
}

TEST_CASE("looking around turns the view with the pointer and keeps the eye") {
    World world;
    add_cube(world);
    Viewer viewer(world, add_eye(world, {0, 0, 5}));
    const Viewport viewport = make_viewport(world, viewer.entity(), {640, 480});
    viewer.look_by({120.0F, 0.0F}, viewport);  // a quarter of the height: 45 degrees to the right
    CHECK(glm::distance(viewer.orbit().forward(), glm::normalize(glm::vec3(1, 0, -1))) < rounding);
    viewer.look_by({0.0F, -1000.0F}, viewport);
    CHECK(viewer.orbit().forward().y > 0.99F);
    CHECK((viewer.orbit().rotation * glm::vec3(0, 1, 0)).y > 0.0F);  // not over the pole
    CHECK(glm::distance(viewer.orbit().eye, {0, 0, 5}) < rounding);
}

TEST_CASE("panning keeps the pivot's plane under the pointer") {
    World world;
    add_cube(world);
    Viewer viewer(world, add_eye(world, {1, 2, 5}));
    const glm::vec3 point = viewer.orbit().pivot();
    const glm::vec2 size(640.0F, 480.0F);
    const glm::vec2 before = project(make_viewport(world, viewer.entity(), size), point).value();
    const glm::vec2 motion(37.0F, -22.0F);
    viewer.pan_by(motion, make_viewport(world, viewer.entity(), size));
    const glm::vec2 after = project(make_viewport(world, viewer.entity(), size), point).value();
    CHECK(glm::distance(after, before + motion) < 1e-2F);  // a hundredth of a pixel
}

TEST_CASE(
    "a framed sphere fits the picture in both directions, in wide and tall pictures and both "
    "projections") {
    const Bounds sphere{{1.0F, -2.0F, 0.5F}, 0.7F};
    for (const auto projection : {Camera::Projection::perspective, Camera::Projection::orthographic}) {
        for (const glm::vec2 size : {glm::vec2(640.0F, 480.0F), glm::vec2(200.0F, 800.0F)}) {
            World world;
            add_cube(world);
            Viewer viewer(world,
                          add_eye(world, {3, 2, 5}, {}, {.projection = projection, .far_plane = 7.0F}));
            const glm::quat rotation = viewer.orbit().rotation;
            viewer.frame(sphere, size.x / size.y);
            CHECK(viewer.orbit().rotation == rotation);
            CHECK(glm::distance(viewer.orbit().pivot(), sphere.centre) < rounding);
            const auto [left, right, top, bottom] = extremes(world, viewer, size, sphere);
            CHECK(left >= 0.0F);
            CHECK(right <= 1.0F);
            CHECK(top >= 0.0F);
            CHECK(bottom <= 1.0F);
            CHECK(std::max(right - left, bottom - top) > 0.8F);  // no farther away than necessary
            const Camera& lens = world.get<Camera>(viewer.entity());
            CHECK(lens.near_plane < viewer.orbit().distance - sphere.radius);
            CHECK(lens.far_plane > viewer.orbit().distance + sphere.radius);
        }
    }
}

TEST_CASE("the view comes back to the scene's camera") {
    World world;
    add_cube(world);
    const Entity camera = add_eye(world, {3, 2, 5}, {}, {.vertical_fov = 0.5F, .near_plane = 0.2F});
    Viewer viewer(world, camera);
    const OrbitCamera before = viewer.orbit();
    viewer.zoom_by(3.0F);
    viewer.frame({{5, 5, 5}, 0.0F}, 1.0F);
    CHECK(viewer.orbit().distance > 0.0F);
    viewer.reset();
    CHECK(viewer.orbit().eye == before.eye);
    CHECK(viewer.orbit().rotation == before.rotation);
    CHECK(world.get<Camera>(viewer.entity()) == world.get<Camera>(camera));
    world.remove<Camera>(camera);
    viewer.reset();  // nothing to come back to
    CHECK(viewer.orbit().eye == before.eye);
}
}  // TEST_SUITE("viewer")

}  // namespace candela::sandbox
