#include "sandbox/editing/orbit_camera.hpp"

#include <cmath>

#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace candela::sandbox {

TEST_SUITE("orbit camera") {

namespace {

// A few roundings of floats of magnitude 10.
constexpr float rounding = 1e-5F;

OrbitCamera some_camera() {
    const glm::mat4 pose = glm::inverse(
        glm::lookAt(glm::vec3(3.0F, 2.0F, 5.0F), glm::vec3(1.0F, 1.0F, -1.0F), glm::vec3(0.0F, 1.0F, 0.0F)));
    return look_from(pose, glm::vec3(1.0F, 1.0F, -1.0F), 0.1F);
}

float distance(glm::vec3 a, glm::vec3 b) {
    return glm::distance(a, b);
}

/// The vertical component of the camera's right axis: 0 if the camera does not roll.
float roll(const OrbitCamera& camera) {
    return (camera.rotation * glm::vec3(1.0F, 0.0F, 0.0F)).y;
}

}  // namespace

TEST_CASE("a viewpoint keeps its pose, drops its scale, and has its target as pivot") {
    const OrbitCamera camera = some_camera();
    CHECK(distance(camera.eye, {3.0F, 2.0F, 5.0F}) < rounding);
    CHECK(distance(camera.pivot(), {1.0F, 1.0F, -1.0F}) < rounding);

    glm::mat4 scaled(1.0F);
    scaled[0] *= 2.0F;
    scaled[1] *= 3.0F;
    scaled[2] *= 4.0F;
    CHECK(distance(look_from(scaled, {0.0F, 0.0F, -2.0F}, 0.1F).forward(), {0.0F, 0.0F, -1.0F}) < rounding);
}

TEST_CASE("the pivot is in front of the camera, even if the target is behind it") {
    CHECK(look_from(glm::mat4(1.0F), {0.0F, 0.0F, 7.0F}, 0.25F).distance == 0.25F);
}

TEST_CASE("orbiting keeps the pivot, the distance to it and the horizon") {
    const OrbitCamera before = some_camera();
    OrbitCamera camera = before;
    for (int i = 0; i < 20; ++i) camera = orbited(camera, {0.3F, i % 2 == 0 ? 0.2F : -0.25F});
    CHECK(distance(camera.pivot(), before.pivot()) < 20.0F * rounding);
    CHECK(camera.distance == before.distance);
    CHECK(std::abs(roll(camera)) < 20.0F * rounding);
}

TEST_CASE("orbiting to the right or up moves the camera to the right or up") {
    const OrbitCamera front = look_from(glm::translate(glm::mat4(1.0F), {0.0F, 0.0F, 2.0F}), {}, 0.1F);
    CHECK(distance(orbited(front, {glm::half_pi<float>(), 0.0F}).eye, {2.0F, 0.0F, 0.0F}) < rounding);
    const float half = std::sqrt(2.0F);
    CHECK(distance(orbited(front, {0.0F, glm::quarter_pi<float>()}).eye, {0.0F, half, half}) < rounding);
}

TEST_CASE("orbiting stops at the poles, and can turn back") {
    OrbitCamera camera = some_camera();
    for (int i = 0; i < 50; ++i) camera = orbited(camera, {0.0F, 0.3F});
    CHECK(camera.forward().y < -0.99F);
    CHECK((camera.rotation * glm::vec3(0.0F, 1.0F, 0.0F)).y > 0.0F);
    for (int i = 0; i < 50; ++i) camera = orbited(camera, {0.0F, -0.3F});
    CHECK(camera.forward().y > 0.99F);
    CHECK((camera.rotation * glm::vec3(0.0F, 1.0F, 0.0F)).y > 0.0F);
}

TEST_CASE("panning moves along the picture, zooming along the view") {
    const OrbitCamera camera = some_camera();
    const OrbitCamera aside = moved(camera, {0.5F, -0.25F, 0.0F});
    CHECK(std::abs(glm::dot(aside.eye - camera.eye, camera.forward())) < rounding);
    CHECK(std::abs(distance(aside.eye, camera.eye) - std::hypot(0.5F, 0.25F)) < rounding);

    const OrbitCamera nearer = zoomed(camera, 0.5F);
    CHECK(distance(nearer.pivot(), camera.pivot()) < rounding);
    CHECK(std::abs(distance(nearer.eye, camera.pivot()) - 0.5F * camera.distance) < rounding);
}
}  // TEST_SUITE("orbit camera")

}  // namespace candela::sandbox
