#include "sandbox/editing/history.hpp"

#include <doctest/doctest.h>

#include "sandbox/editing/objects.hpp"
#include "sandbox/editing/placing.hpp"
#include "tests/sandbox/editing_scene.hpp"

namespace candela::sandbox {

namespace {

void set_x(World& world, Entity entity, float x) {
    world.edit<Transform>(entity, [&](Transform& transform) { transform.translation.x = x; });
}

float x_of(const World& world, Entity entity) {
    return world.get<Transform>(entity).translation.x;
}

void move_x(World& world, History& history, Entity entity, float x) {
    history.begin(world, "move", {entity});
    set_x(world, entity, x);
    history.commit(world);
}

void record_x(World& world, History& history, Entity entity, float x) {
    EntityStates before = states_of(world, {entity});
    set_x(world, entity, x);
    history.record(world, "nudge", std::move(before));
}

}  // namespace

TEST_SUITE("history") {
TEST_CASE("undo and redo restore all components, those that were added or removed too") {
    World world;
    History history;
    const Entity entity = world.create();
    world.set(entity, Name{"lamp"});
    world.set(entity, SpotLight{.intensity = 3.0F});
    const EntityState before = state_of(world, entity);
    history.begin(world, "change lamp", {entity});
    world.remove<SpotLight>(entity);
    world.set(entity, PointLight{.range = 2.0F});
    world.set(entity, Transform{.translation = {1, 2, 3}});
    world.set(entity, DirectionalLight{});
    world.set(entity, MeshInstance{square(1.0F)});
    world.set(entity, Environment{.radiance = glm::vec3(1.0F), .picture = nullptr});
    world.set(entity, Camera{.vertical_fov = 1.0F});
    history.commit(world);
    const EntityState after = state_of(world, entity);
    CHECK(after != before);
    CHECK(history.undo_name() == "change lamp");
    CHECK(history.undo(world) == std::vector{entity});
    CHECK(state_of(world, entity) == before);
    CHECK(history.redo_name() == "change lamp");
    CHECK(history.redo(world) == std::vector{entity});
    CHECK(state_of(world, entity) == after);
    CHECK(history.redo(world).empty());
}

TEST_CASE("a cancelled edit leaves neither a change nor an entry") {
    World world;
    History history;
    const Entity light = add_point_light(world, {1, 0, 0});
    history.begin(world, "move", {light});
    set_x(world, light, 5.0F);
    history.cancel(world);
    CHECK(x_of(world, light) == 1.0F);
    CHECK_FALSE(history.undo_name());
}

TEST_CASE("an edit that changes nothing is not kept, and undo ends an open one") {
    World world;
    History history;
    const Entity light = add_point_light(world, {1, 0, 0});
    move_x(world, history, light, 1.0F);
    CHECK_FALSE(history.undo_name());
    history.begin(world, "move", {light});
    set_x(world, light, 5.0F);
    history.undo(world);
    CHECK(x_of(world, light) == 1.0F);
    history.redo(world);
    CHECK(x_of(world, light) == 5.0F);
}

TEST_CASE("a new edit after undo forgets what could be redone") {
    World world;
    History history;
    const Entity light = add_point_light(world, {0, 0, 0});
    move_x(world, history, light, 1.0F);
    move_x(world, history, light, 2.0F);
    history.undo(world);
    move_x(world, history, light, 3.0F);
    CHECK_FALSE(history.redo_name());
    history.undo(world);
    CHECK(x_of(world, light) == 1.0F);
}

TEST_CASE("recorded changes of one gesture are one edit") {
    World world;
    History history;
    const Entity light = add_point_light(world, {0, 0, 0});
    for (const float x : {1.0F, 2.0F, 3.0F}) record_x(world, history, light, x);
    history.end_of_gesture();
    for (const float x : {4.0F, 5.0F}) record_x(world, history, light, x);
    move_x(world, history, light, 6.0F);
    record_x(world, history, light, 7.0F);
    for (const float x : {6.0F, 5.0F, 3.0F, 0.0F}) {
        history.undo(world);
        CHECK(x_of(world, light) == x);
    }
    CHECK_FALSE(history.undo_name());
}

TEST_CASE("changes of different entities do not join") {
    World world;
    History history;
    const Entity a = add_point_light(world, {0, 0, 0});
    const Entity b = add_point_light(world, {0, 0, 0});
    record_x(world, history, a, 1.0F);
    record_x(world, history, b, 1.0F);
    history.undo(world);
    CHECK(x_of(world, a) == 1.0F);
    CHECK(x_of(world, b) == 0.0F);
}

TEST_CASE("the oldest edits are forgotten") {
    World world;
    History history(3);
    const Entity light = add_point_light(world, {0, 0, 0});
    for (const float x : {1.0F, 2.0F, 3.0F, 4.0F, 5.0F}) move_x(world, history, light, x);
    while (!history.undo(world).empty()) {
    }
    CHECK(x_of(world, light) == 2.0F);
}

}  // TEST_SUITE("history")

TEST_SUITE("objects") {
TEST_CASE("names are made unique by a number") {
    World world;
    for (const char* name : {"lamp", "lamp 3", "7"}) world.set(world.create(), Name{name});
    CHECK(unique_name(world, "sun") == "sun");
    CHECK(unique_name(world, "lamp") == "lamp 2");
    CHECK(unique_name(world, "lamp 3") == "lamp 2");
    CHECK(unique_name(world, "7") == "7 2");
    CHECK(unique_name(world, "lamp3") == "lamp3");
}

TEST_CASE("an added light stands and points as told, and undo takes all of it away") {
    World world;
    History history;
    const Entity spot = add_light(world, history, SpotLight{}, {1, 2, 3}, {0, -2, 0}, 3.0F);
    CHECK(position_of(world, spot) == glm::vec3(1, 2, 3));
    CHECK(glm::distance(direction_of(world, spot), {0, -1, 0}) < 1e-6F);
    // E = I / d² is 2 lux at 3 metres.
    CHECK(world.get<SpotLight>(spot).intensity == 18.0F);
    world.edit<SpotLight>(spot, [](SpotLight& light) { light.intensity = 5.0F; });
    const Entity next = add_light(world, history, SpotLight{}, {}, {1, 0, 0}, 3.0F);
    CHECK(world.get<SpotLight>(next).intensity == 5.0F);
    CHECK(world.get<Name>(next).value == "spot light 2");
    history.undo(world);
    CHECK_FALSE(is_present(world, next));
    CHECK(world.alive(next));
    history.redo(world);
    CHECK(glm::distance(direction_of(world, next), {1, 0, 0}) < 1e-6F);
}

TEST_CASE("a copy has all that is below, in place but for the offset, under names of its own") {
    World world;
    History history;
    const Entity parent = add_skewing_parent(world);
    const Entity group = add_point_light(world, {1, 0, 0}, parent);
    const Entity child = add_mesh(world, cube(1.0F), {.translation = {0, 1, 0}, .parent = group});
    world.set(group, Name{"lamp"});
    world.set(child, Name{"bulb"});
    const Entity copy = duplicate(world, history, group, {0.5F, 0.0F, 0.0F});
    CHECK(world.get<Name>(copy).value == "lamp 2");
    CHECK(world.get<PointLight>(copy) == world.get<PointLight>(group));
    const glm::vec3 moved_by = position_of(world, copy) - position_of(world, group);
    CHECK(glm::distance(moved_by, {0.5F, 0.0F, 0.0F}) < 1e-5F);
    const auto family = family_of(world, copy);
    REQUIRE(family.size() == 2);
    const Entity bulb = family[0] == copy ? family[1] : family[0];
    CHECK(world.get<Name>(bulb).value == "bulb 2");
    CHECK(glm::distance(position_of(world, bulb) - position_of(world, child), moved_by) < 1e-5F);
    history.undo(world);
    CHECK_FALSE(is_present(world, copy));
    CHECK_FALSE(is_present(world, bulb));
    CHECK(is_present(world, child));
}

TEST_CASE("a deleted parent leaves its children where they are, and comes back") {
    World world;
    History history;
    const Entity parent = add_point_light(world, {1, 0, 0});
    const Entity child = add_point_light(world, {0, 2, 0}, parent);
    const EntityState before = state_of(world, parent);
    remove(world, history, parent);
    CHECK_FALSE(world.has<PointLight>(parent));
    CHECK(position_of(world, child) == glm::vec3(1, 2, 0));
    remove(world, history, child);
    CHECK_FALSE(is_present(world, child));
    history.undo(world);
    history.undo(world);
    CHECK(state_of(world, parent) == before);
    CHECK(position_of(world, child) == glm::vec3(1, 2, 0));
}

}  // TEST_SUITE("objects")

}  // namespace candela::sandbox
