#include "sandbox/editing/light_picking.hpp"

#include <array>
#include <cmath>

#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <candela/scene/components.hpp>
#include <candela/scene/hierarchy.hpp>

namespace candela::sandbox {

TEST_SUITE("light picking") {

namespace {

constexpr glm::vec2 window(640.0F, 480.0F);

// A hundredth of a pixel, and about the same in metres at the distances below.
constexpr float tolerance_window = 1e-2F;
constexpr float tolerance_world = 1e-4F;

/// Looks along -Z from (0, 0, 5). At the origin, the window is 10·tan(fov/2) metres high.
Entity add_camera(World& world, Camera::Projection projection = Camera::Projection::perspective) {
    const Entity entity = world.create();
    world.set(entity, Transform{.translation = {0.0F, 0.0F, 5.0F}});
    world.set(entity,
              Camera{.projection = projection, .half_height = 2.0F, .near_plane = 0.1F, .far_plane = 50.0F});
    return entity;
}

Entity add_light(World& world, glm::vec3 position, Entity parent = {}) {
    const Entity entity = world.create();
    world.set(entity, Transform{.translation = position, .parent = parent});
    world.set(entity, PointLight{});
    return entity;
}

glm::vec3 position_of(const World& world, Entity entity) {
    return glm::vec3(world_matrix(world, entity)[3]);
}

}  // namespace

TEST_CASE("points are projected as by a pinhole camera, with y downwards") {
    World world;
    const Viewport viewport = make_viewport(world, add_camera(world), window);
    const float units_per_metre = 240.0F / (5.0F * std::tan(Camera{}.vertical_fov * 0.5F));
    const auto seen_at = project(viewport, {0.5F, 1.0F, 0.0F});
    REQUIRE(seen_at);
    CHECK(std::abs(seen_at->x - (320.0F + 0.5F * units_per_metre)) < tolerance_window);
    CHECK(std::abs(seen_at->y - (240.0F - units_per_metre)) < tolerance_window);
    CHECK_FALSE(project(viewport, {0.0F, 0.0F, 6.0F}));
}

TEST_CASE("the ray through the projection of a point hits the point, in both projections") {
    for (const auto projection : {Camera::Projection::perspective, Camera::Projection::orthographic}) {
        World world;
        const Viewport viewport = make_viewport(world, add_camera(world, projection), window);
        for (const glm::vec3 point :
             {glm::vec3(0.0F), glm::vec3(1.0F, -0.7F, 2.0F), glm::vec3(-2.0F, 1.0F, -9.0F)}) {
            const tools::Ray ray = ray_through(viewport, project(viewport, point).value());
            CHECK(std::abs(glm::length(ray.direction) - 1.0F) < tolerance_world);
            CHECK(glm::length(glm::cross(point - ray.origin, ray.direction)) < tolerance_world);
            const auto met = intersect_plane(ray, point, viewport.forward);
            REQUIRE(met);
            CHECK(glm::distance(*met, point) < tolerance_world);
        }
    }
}

TEST_CASE("a picture beside a panel is picked in window coordinates") {
    World world;
    const Entity camera = add_camera(world);
    const glm::vec2 origin(200.0F, 30.0F);
    const Viewport whole = make_viewport(world, camera, window);
    const Viewport beside = make_viewport(world, camera, window, origin);
    const glm::vec3 point(1.0F, -0.7F, 2.0F);
    const glm::vec2 seen_at = project(whole, point).value() + origin;
    CHECK(glm::distance(project(beside, point).value(), seen_at) < tolerance_window);
    const tools::Ray ray = ray_through(beside, seen_at);
    CHECK(glm::length(glm::cross(point - ray.origin, ray.direction)) < tolerance_world);
    CHECK(beside.contains({201.0F, 31.0F}));
    CHECK_FALSE(beside.contains({199.0F, 31.0F}));
    CHECK_FALSE(beside.contains({201.0F, 511.0F}));
}

TEST_CASE("a metre at the depth of a point is as long as metres_per_unit says, in both projections") {
    for (const auto projection : {Camera::Projection::perspective, Camera::Projection::orthographic}) {
        World world;
        const Viewport viewport = make_viewport(world, add_camera(world, projection), window);
        const glm::vec3 point(0.5F, 0.2F, 1.0F);
        const float units = glm::distance(project(viewport, point).value(),
                                          project(viewport, point + glm::vec3(0, 1, 0)).value());
        CHECK(std::abs(units * metres_per_unit(viewport, point) - 1.0F) < tolerance_world);
    }
}

TEST_CASE("rays miss planes that are parallel or behind") {
    const tools::Ray ray{glm::vec3(0.0F), glm::vec3(0.0F, 0.0F, -1.0F)};
    CHECK_FALSE(intersect_plane(ray, {0.0F, 1.0F, 0.0F}, {0.0F, 1.0F, 0.0F}));
    CHECK_FALSE(intersect_plane(ray, {0.0F, 0.0F, 1.0F}, {0.0F, 0.0F, 1.0F}));
}

TEST_CASE("the nearest marker within the radius is picked") {
    World world;
    const Viewport viewport = make_viewport(world, add_camera(world), window);
    const Entity left = add_light(world, {-0.1F, 0.0F, 0.0F});
    const Entity right = add_light(world, {0.1F, 0.0F, 0.0F});
    add_light(world, {0.0F, 0.0F, 9.0F});  // behind the eye
    const auto markers = light_markers(world);
    CHECK(markers.size() == 3);
    CHECK(pick(markers, viewport, {318.0F, 240.0F}, 20.0F) == left);
    CHECK(pick(markers, viewport, {322.0F, 240.0F}, 20.0F) == right);
    CHECK_FALSE(pick(markers, viewport, {320.0F, 300.0F}, 20.0F));
}

TEST_CASE("nudging moves a light along the picture's axes") {
    World world;
    const Viewport viewport = make_viewport(world, add_camera(world), window);
    const Entity light = add_light(world, glm::vec3(0.0F));
    nudge(world, light, viewport, {1.0F, 2.0F, 3.0F});
    CHECK(glm::distance(position_of(world, light), {1.0F, 2.0F, 3.0F}) < tolerance_world);
}
}  // TEST_SUITE("light picking")

}  // namespace candela::sandbox
