#include "sandbox/editing/drag.hpp"

#include <cmath>
#include <random>

#include <doctest/doctest.h>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <candela/scene/hierarchy.hpp>
#include "engine/bvh/box.hpp"
#include "sandbox/editing/placing.hpp"
#include "sandbox/scene/scene.hpp"
#include "tests/sandbox/editing_scene.hpp"

namespace candela::sandbox {

TEST_SUITE("drag") {

namespace {

constexpr glm::vec2 size(640.0F, 480.0F);
constexpr glm::vec2 origin(100.0F, 50.0F);

// A hundredth of a pixel, and about the same in metres at the distances below.
constexpr float tolerance_window = 1e-2F;
constexpr float tolerance_world = 1e-4F;

constexpr float gap = 0.1F;

/// A room's floor at y = 0 and a light over it, seen obliquely from above.
struct EditedScene {
    World world;
    Entity floor = add_mesh(world, square(10.0F),
                            {.rotation = glm::angleAxis(-glm::half_pi<float>(), glm::vec3(1, 0, 0))});
    Entity eye = add_eye(world, {2.0F, 3.0F, 6.0F}, {0.0F, 0.5F, 0.0F});
    Viewport viewport = make_viewport(world, eye, size, origin);
    tools::SceneRays surfaces;

    EditedScene() { surfaces.update_and_wait(world); }

    glm::vec2 seen(const glm::vec3& point) const { return project(viewport, point).value(); }

    Drag grab(Entity entity, DragMode mode, glm::vec2 pointer) {
        return {world, viewport, entity, mode, position_of(world, entity), pointer};
    }
    void follow(const Drag& drag, glm::vec2 pointer) { drag.follow(world, viewport, pointer, surfaces, gap); }
};

}  // namespace

TEST_CASE("in the plane of the view, the grabbed point stays under the pointer and keeps its depth") {
    EditedScene scene;
    const glm::vec3 start(0.3F, 1.2F, 0.4F);
    const Entity light = add_point_light(scene.world, {}, add_skewing_parent(scene.world));
    move_to(scene.world, light, start);
    const glm::vec2 grip(5.0F, -4.0F);
    const Drag drag = scene.grab(light, {}, scene.seen(start) + grip);
    for (const glm::vec2 pointer : {glm::vec2(180.0F, 400.0F), glm::vec2(600.0F, 90.0F)}) {
        scene.follow(drag, pointer + grip);
        const glm::vec3 now = position_of(scene.world, light);
        CHECK(glm::distance(scene.seen(now), pointer) < tolerance_window);
        CHECK(std::abs(glm::dot(now - start, scene.viewport.forward)) < tolerance_world);
    }
    scene.follow(drag, scene.seen(start) + grip);
    CHECK(glm::distance(position_of(scene.world, light), start) < tolerance_world);
}

TEST_CASE("along an axis, the point stays on the axis and under a pointer that stays on it") {
    EditedScene scene;
    const glm::vec3 start(0.3F, 1.2F, 0.4F);
    const Entity light = add_point_light(scene.world, {}, add_skewing_parent(scene.world));
    for (const int axis : {0, 1, 2}) {
        glm::vec3 direction(0.0F);
        direction[axis] = 1.0F;
        move_to(scene.world, light, start);
        // Grabbed at half a metre along the axis.
        const Drag drag =
            scene.grab(light, {DragKind::move_along_axis, axis}, scene.seen(start + 0.5F * direction));
        scene.follow(drag, scene.seen(start + 1.25F * direction));
        CHECK(glm::distance(position_of(scene.world, light), start + 0.75F * direction) < tolerance_world);
        scene.follow(drag, scene.seen(start + 1.25F * direction) + glm::vec2(13.0F, -17.0F));
        const glm::vec3 moved = position_of(scene.world, light) - start;
        CHECK(glm::length(glm::cross(moved, direction)) < tolerance_world);
    }
}

TEST_CASE("along an axis that points at the eye, or beyond its vanishing point, nothing moves") {
    EditedScene scene;
    const Entity front = add_eye(scene.world, {0.0F, 1.0F, 5.0F}, {0.0F, 1.0F, 0.0F});
    scene.viewport = make_viewport(scene.world, front, size, origin);
    const Entity light = add_point_light(scene.world, {0.0F, 1.0F, 0.0F});
    const Drag drag = scene.grab(light, {DragKind::move_along_axis, 2}, scene.seen({0.0F, 1.0F, 0.0F}));
    scene.follow(drag, {300.0F, 300.0F});
    CHECK(position_of(scene.world, light) == glm::vec3(0.0F, 1.0F, 0.0F));

    // The axis vanishes in the middle of the picture.
    move_to(scene.world, light, {1.0F, 1.0F, 0.0F});
    const Drag aside = scene.grab(light, {DragKind::move_along_axis, 2}, scene.seen({1.0F, 1.0F, 0.0F}));
    for (float x = -200.0F; x < 300.0F; x += 10.0F) {
        scene.follow(aside, origin + 0.5F * size + glm::vec2(x, 0.0F));
        const float z = position_of(scene.world, light).z;
        CHECK(std::isfinite(z));
        CHECK(z <= 5.0F);
        CHECK(z > -200.0F);
    }
}

TEST_CASE("over a surface, a light keeps the gap and an object rests on it") {
    EditedScene scene;
    const Entity light = add_point_light(scene.world, {0.0F, 2.0F, 0.0F});
    const Entity parent = add_skewing_parent(scene.world);
    const Entity box = add_mesh(scene.world, cube(0.25F), {.parent = parent});
    scene.surfaces.update_and_wait(scene.world);
    const glm::vec3 target(-1.0F, 0.0F, 1.0F);
    const Drag drag = scene.grab(light, {DragKind::move_over_surface}, {0.0F, 0.0F});
    scene.follow(drag, scene.seen(target));
    CHECK(glm::distance(position_of(scene.world, light), target + glm::vec3(0.0F, gap, 0.0F)) <
          tolerance_world);

    const Drag of_box = scene.grab(box, {DragKind::move_over_surface}, {0.0F, 0.0F});
    for (int twice = 0; twice < 2; ++twice) {  // the second time, the box itself is under the pointer
        scene.follow(of_box, scene.seen(target));
        scene.surfaces.update(scene.world);
        const glm::vec3 at = position_of(scene.world, box);
        CHECK(std::abs(at.x - target.x) + std::abs(at.z - target.z) < tolerance_world);
        CHECK(std::abs(box_of(scene.world, {box}).lower.y) < tolerance_world);
    }
    const glm::vec3 before = position_of(scene.world, light);
    scene.follow(drag, scene.seen(scene.viewport.forward * 1000.0F + glm::vec3(0.0F, 900.0F, 0.0F)));
    CHECK(position_of(scene.world, light) == before);  // the sky
}

TEST_CASE("turning around an axis follows the pointer, also below a parent") {
    EditedScene scene;
    const Entity parent = scene.world.create();
    scene.world.set(parent, Transform{.rotation = glm::angleAxis(0.7F, glm::normalize(glm::vec3(1, 2, 3))),
                                      .scale = glm::vec3(-2.0F)});
    const Entity box = add_mesh(scene.world, cube(0.25F), {.parent = parent});
    const glm::mat3 before(world_matrix(scene.world, box));
    const glm::vec3 centre = position_of(scene.world, box);
    const Drag drag =
        scene.grab(box, {DragKind::turn_around_axis, 1}, scene.seen(centre + glm::vec3(0.0F, 0.0F, 1.0F)));
    scene.follow(drag, scene.seen(centre + 2.0F * glm::vec3(std::sin(0.6F), 0.0F, std::cos(0.6F))));
    const glm::mat3 expected = glm::mat3(glm::rotate(glm::mat4(1.0F), 0.6F, glm::vec3(0, 1, 0))) * before;
    const glm::mat3 now(world_matrix(scene.world, box));
    for (const int column : {0, 1, 2}) {
        CHECK(glm::distance(now[column], expected[column]) < tolerance_world);
    }
    CHECK(glm::distance(position_of(scene.world, box), centre) < tolerance_world);
}

TEST_CASE("turning around the view turns the picture of the object") {
    EditedScene scene;
    const Entity box = add_mesh(scene.world, cube(0.25F), {.translation = {0.0F, 0.5F, 0.0F}});
    const glm::vec2 centre = scene.seen({0.0F, 0.5F, 0.0F});
    CHECK(glm::distance(centre, origin + 0.5F * size) < tolerance_window);
    const Drag drag = scene.grab(box, {DragKind::turn_around_view}, centre + glm::vec2(80.0F, 0.0F));
    scene.follow(drag, centre + glm::vec2(0.0F, -120.0F));  // a quarter turn, counter-clockwise
    const glm::vec3 right = scene.world.get<Transform>(scene.eye).rotation * glm::vec3(1, 0, 0);
    const glm::vec3 up = scene.world.get<Transform>(scene.eye).rotation * glm::vec3(0, 1, 0);
    const glm::quat turned = scene.world.get<Transform>(box).rotation;
    CHECK(glm::distance(turned * right, up) < tolerance_world);
}

TEST_CASE("aiming points a light at what is under the pointer, also below a skewing parent") {
    EditedScene scene;
    const Entity light = scene.world.create();
    scene.world.set(light, Transform{.parent = add_skewing_parent(scene.world)});
    scene.world.set(light, SpotLight{});
    const glm::vec3 target(-1.0F, 0.0F, 1.0F);
    const Drag drag = scene.grab(light, {DragKind::aim}, {0.0F, 0.0F});
    scene.follow(drag, scene.seen(target));
    const glm::vec3 wanted = glm::normalize(target - position_of(scene.world, light));
    CHECK(glm::distance(direction_of(scene.world, light), wanted) < tolerance_world);
}

TEST_CASE("scaling along an axis keeps the grabbed point under the pointer, and uniform scaling doubles") {
    EditedScene scene;
    const Entity box = add_mesh(scene.world, cube(0.25F),
                                {.translation = {0.0F, 0.5F, 0.0F},
                                 .rotation = glm::angleAxis(0.4F, glm::vec3(0, 1, 0)),
                                 .scale = glm::vec3(2.0F)});
    const glm::vec3 local(0.0F, 0.0F, 0.3F);
    const auto grip = [&] { return glm::vec3(world_matrix(scene.world, box) * glm::vec4(local, 1.0F)); };
    const glm::vec3 centre = position_of(scene.world, box);
    const glm::vec3 start = grip();
    const Drag drag = scene.grab(box, {DragKind::scale_along_axis, 2}, scene.seen(start));
    const glm::vec2 pointer = scene.seen(centre + 1.5F * (start - centre));
    scene.follow(drag, pointer);
    CHECK(glm::distance(scene.world.get<Transform>(box).scale, {2.0F, 2.0F, 3.0F}) < tolerance_world);
    CHECK(glm::distance(scene.seen(grip()), pointer) < tolerance_window);
    scene.follow(drag, scene.seen(centre - 3.0F * (start - centre)));
    CHECK(scene.world.get<Transform>(box).scale.z > 0.0F);

    const Drag uniform = scene.grab(box, {DragKind::scale}, {300.0F, 300.0F});
    const glm::vec3 before = scene.world.get<Transform>(box).scale;
    scene.follow(uniform, {400.0F, 300.0F});
    CHECK(glm::distance(scene.world.get<Transform>(box).scale, 2.0F * before) < tolerance_world);
}

TEST_CASE("whatever is dragged in whatever view, numbers stay finite") {
    EditedScene scene;
    std::mt19937 random(1);
    std::uniform_real_distribution<float> pointer(-2000.0F, 2000.0F);
    std::uniform_int_distribution<int> whole(-2, 2);
    const auto somewhere = [&] { return glm::vec3(whole(random), whole(random), whole(random)); };
    const Entity box = add_mesh(scene.world, cube(0.25F));
    for (int i = 0; i < 2000; ++i) {
        // On whole numbers, so that many axes point exactly at the eye, or the eye is inside the box.
        scene.world.set(box, Transform{.translation = somewhere()});
        scene.world.edit<Transform>(scene.eye, [&](Transform& eye) {
            eye.translation = somewhere();
            eye.rotation = glm::angleAxis(glm::quarter_pi<float>() * static_cast<float>(whole(random)),
                                          glm::vec3(i % 2, 1 - i % 2, 0));
        });
        scene.viewport = make_viewport(scene.world, scene.eye, size, origin);
        const DragMode mode{static_cast<DragKind>(i % 8), i % 3};
        const Drag drag = scene.grab(box, mode, {pointer(random), pointer(random)});
        for (int step = 0; step < 3; ++step) scene.follow(drag, {pointer(random), pointer(random)});
        const glm::mat4 matrix = world_matrix(scene.world, box);
        for (const int column : {0, 1, 2, 3}) REQUIRE(std::isfinite(glm::length(matrix[column])));
    }
}

TEST_CASE("another mode continues from the start") {
    EditedScene scene;
    const Entity light = add_point_light(scene.world, {0.0F, 1.0F, 0.0F});
    Drag drag = scene.grab(light, {}, scene.seen({0.0F, 1.0F, 0.0F}));
    scene.follow(drag, {200.0F, 200.0F});
    drag.set_mode(scene.world, {DragKind::move_along_axis, 0});
    CHECK(position_of(scene.world, light) == glm::vec3(0.0F, 1.0F, 0.0F));
    scene.follow(drag, scene.seen({0.5F, 1.0F, 0.0F}));
    CHECK(glm::distance(position_of(scene.world, light), {0.5F, 1.0F, 0.0F}) < tolerance_world);
}

TEST_CASE("below a parent that is scaled to zero nothing moves, turns or aims") {
    EditedScene scene;
    const Entity parent = scene.world.create();
    scene.world.set(parent, Transform{.scale = {1.0F, 0.0F, 1.0F}});
    const Entity light = add_point_light(scene.world, {1.0F, 0.5F, 0.0F}, parent);
    const Transform before = scene.world.get<Transform>(light);
    for (const DragKind kind : {DragKind::move_in_plane, DragKind::move_along_axis,
                                DragKind::move_over_surface, DragKind::turn_around_axis, DragKind::aim}) {
        const Drag drag = scene.grab(light, {kind, 1}, {300.0F, 300.0F});
        scene.follow(drag, {350.0F, 350.0F});
        CHECK(scene.world.get<Transform>(light) == before);
    }
}
}  // TEST_SUITE("drag")

}  // namespace candela::sandbox
