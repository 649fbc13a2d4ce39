#include "sandbox/editing/object_tree.hpp"

#include <doctest/doctest.h>

#include "tests/sandbox/editing_scene.hpp"

namespace candela::sandbox {

TEST_SUITE("object tree") {

namespace {

/// Two lamps and a table, of which one lamp stands on the table, in a room.
struct Room {
    World world;
    Entity room = world.create();
    Entity table = add_mesh(world, cube(0.5F), {.parent = room});
    Entity lamp = add_point_light(world, {}, table);
    Entity sun = world.create();

    Room() {
        world.set(room, Transform{});
        world.set(room, Name{"room"});
        world.set(table, Name{"Table"});
        world.set(lamp, Name{"table lamp"});
        world.set(sun, Name{"sun"});
        world.set(sun, DirectionalLight{});
        add_eye(world, {0.0F, 0.0F, 5.0F});  // cameras are no objects
    }
};

}  // namespace

TEST_CASE("objects stand below their parents, by name") {
    Room room;
    const auto rows = object_rows(room.world);
    CHECK(rows == std::vector<ObjectRow>{{room.room, "room", "group", 0},
                                         {room.table, "Table", "mesh", 1},
                                         {room.lamp, "table lamp", "point light", 2},
                                         {room.sun, "sun", "directional light", 0}});
}

TEST_CASE("words are found in names, upper and lower case alike") {
    Room room;
    const auto rows = object_rows(room.world, "TABLE");
    CHECK(rows == std::vector<ObjectRow>{{room.table, "Table", "mesh", 0},
                                         {room.lamp, "table lamp", "point light", 0}});
    CHECK(object_rows(room.world, "chair").empty());
}

TEST_CASE("the rows follow the world and the words") {
    Room room;
    ObjectTree tree;
    CHECK(tree.rows(room.world).size() == 4);
    room.world.set(room.lamp, Name{"reading lamp"});
    CHECK(tree.rows(room.world)[2].name == "reading lamp");
    tree.find = "reading";
    CHECK(tree.rows(room.world).size() == 1);
}
}  // TEST_SUITE("object tree")

}  // namespace candela::sandbox
