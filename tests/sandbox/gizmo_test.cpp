#include "sandbox/editing/gizmo.hpp"

#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "sandbox/editing/light_labels.hpp"
#include "sandbox/editing/placing.hpp"
#include "tests/sandbox/editing_scene.hpp"

namespace candela::sandbox {

namespace {

constexpr glm::vec2 size(640.0F, 480.0F);
constexpr float length = 80.0F;  // of an axis

const Handle* find(const Gizmo& gizmo, DragMode mode) {
    const auto at = std::find_if(gizmo.handles.begin(), gizmo.handles.end(),
                                 [&](const Handle& handle) { return handle.mode == mode; });
    return at == gizmo.handles.end() ? nullptr : &*at;
}

/// A camera that looks along -Z.
Viewport front(World& world, float distance) {
    return make_viewport(world, add_eye(world, {0, 0, distance}), size);
}

}  // namespace

TEST_SUITE("gizmo") {
TEST_CASE("has the same size in the window at every distance") {
    World world;
    const Entity box = add_mesh(world, cube(1.0F));
    for (const float distance : {3.0F, 30.0F, 3000.0F}) {
        const auto gizmo = make_gizmo(world, front(world, distance), box, Tool::move, {}, length).value();
        CHECK(glm::distance(gizmo.centre, 0.5F * size) < 1e-2F);
        const Handle* up = find(gizmo, {DragKind::move_along_axis, 1});
        REQUIRE(up != nullptr);
        CHECK(glm::distance(up->line.back(), gizmo.centre - glm::vec2(0.0F, length)) < 0.1F);
    }
}

TEST_CASE("leaves out what cannot be dragged: axes along the view, rings seen from their side") {
    World world;
    const Entity box = add_mesh(world, cube(1.0F));
    const Viewport viewport = front(world, 5.0F);
    const auto axes = make_gizmo(world, viewport, box, Tool::move, {}, length).value();
    CHECK(find(axes, {DragKind::move_along_axis, 0}) != nullptr);
    CHECK(find(axes, {DragKind::move_along_axis, 2}) == nullptr);
    const auto rings = make_gizmo(world, viewport, box, Tool::turn, {}, length).value();
    CHECK(find(rings, {DragKind::turn_around_axis, 0}) == nullptr);
    CHECK(find(rings, {DragKind::turn_around_axis, 2}) != nullptr);
    CHECK(find(rings, {DragKind::turn_around_view}) != nullptr);
    CHECK_FALSE(make_gizmo(world, viewport, box, Tool::move, {0, 0, 9}, length));
}

TEST_CASE("its scale handles follow the object's own axes") {
    World world;
    const Entity box = add_mesh(world, cube(1.0F),
                                {.rotation = glm::angleAxis(0.5F, glm::vec3(0, 0, 1)), .scale = {3, 1, 1}});
    const auto gizmo = make_gizmo(world, front(world, 5.0F), box, Tool::scale, {}, length).value();
    const glm::vec2 along = find(gizmo, {DragKind::scale_along_axis, 0})->line.back() - gizmo.centre;
    CHECK(glm::distance(along, length * glm::vec2(std::cos(0.5F), -std::sin(0.5F))) < 0.1F);
}

TEST_CASE("the nearest handle within the radius is hit, the dot before lines") {
    World world;
    const Entity box = add_mesh(world, cube(1.0F));
    const auto gizmo = make_gizmo(world, front(world, 5.0F), box, Tool::move, {}, length).value();
    const auto mode_at = [&](glm::vec2 offset) {
        return gizmo.handles[handle_at(gizmo, gizmo.centre + offset, 8.0F).value()].mode;
    };
    CHECK(mode_at({1, -2}) == DragMode{DragKind::move_in_plane});
    CHECK(mode_at({50, 5}) == DragMode{DragKind::move_along_axis, 0});
    CHECK(mode_at({-5, -70}) == DragMode{DragKind::move_along_axis, 1});
    CHECK_FALSE(handle_at(gizmo, gizmo.centre + glm::vec2(50, 9), 8.0F));
    CHECK_FALSE(handle_at(gizmo, gizmo.centre + glm::vec2(-20, 0), 8.0F));
}

TEST_CASE("tools that would change nothing are replaced") {
    World world;
    const Entity point = add_point_light(world, {});
    const Entity spot = world.create();
    world.set(spot, SpotLight{});
    const Entity sun = world.create();
    world.set(sun, DirectionalLight{});
    const Entity box = add_mesh(world, cube(1.0F));
    CHECK(usable_tool(world, point, Tool::turn) == Tool::move);
    CHECK(usable_tool(world, point, Tool::surface) == Tool::surface);
    CHECK(usable_tool(world, spot, Tool::turn) == Tool::turn);
    CHECK(usable_tool(world, spot, Tool::scale) == Tool::move);
    CHECK(usable_tool(world, sun, Tool::move) == Tool::turn);
    CHECK(usable_tool(world, box, Tool::scale) == Tool::scale);
}

}  // TEST_SUITE("gizmo")

TEST_SUITE("light labels") {
TEST_CASE(
    "only the hovered and the selected light are named, and those behind walls are hidden, and come first") {
    World world;
    add_mesh(world, square(1.0F));
    const Entity selected = add_point_light(world, {0.5F, 0.0F, 1.0F});
    const Entity behind = add_point_light(world, {0.0F, 0.0F, -1.0F});
    const Entity hovered = add_point_light(world, {-0.5F, 0.0F, 1.0F});
    add_point_light(world, {0.0F, 50.0F, 1.0F});  // above the picture
    add_point_light(world, {0.0F, 0.0F, 50.0F});  // behind the eye
    world.set(selected, Name{"left"});
    world.set(hovered, Name{"right"});
    world.set(behind, Name{"behind"});
    tools::SceneRays surfaces;
    surfaces.update_and_wait(world);
    const auto labels = light_labels(world, front(world, 5.0F), surfaces, hovered, selected);
    REQUIRE(labels.size() == 3);
    CHECK(labels[0].entity == behind);
    CHECK(labels[0].hidden);
    CHECK(labels[0].name.empty());
    CHECK(labels[1].hovered);
    CHECK(labels[1].name == "right");
    CHECK_FALSE(labels[1].hidden);
    CHECK(labels[2].selected);
    CHECK(labels[2].name == "left");
}

}  // TEST_SUITE("light labels")

}  // namespace candela::sandbox
