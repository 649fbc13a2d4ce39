#include "sandbox/editing/enclosed_lights.hpp"

#include <doctest/doctest.h>

#include "sandbox/scene/scene.hpp"
#include "tests/sandbox/editing_scene.hpp"

namespace candela::sandbox {

TEST_SUITE("enclosed lights") {

namespace {

std::vector<EnclosedLight> found_in(const World& world) {
    tools::SceneRays rays;
    rays.update_and_wait(world);
    return enclosed_lights(world, rays);
}

/// A cube whose front is inside: a room.
std::shared_ptr<const Mesh> room(float half) {
    Mesh turned = *cube(half);
    for (std::size_t i = 0; i < turned.primitives[0].indices.size(); i += 3) {
        std::swap(turned.primitives[0].indices[i], turned.primitives[0].indices[i + 1]);
    }
    return std::make_shared<const Mesh>(std::move(turned));
}

}  // namespace

TEST_CASE("a light in a closed object is found, and named with the object, wherever the object stands") {
    World world;
    add_mesh(world, room(10.0F));
    const Entity block = add_mesh(
        world, cube(0.5F),
        {.translation = {3.0F, 1.0F, 2.0F}, .rotation = glm::angleAxis(0.5F, glm::vec3(0.0F, 1.0F, 0.0F))});
    const Entity inside = add_point_light(world, {3.0F, 1.2F, 2.1F});
    add_point_light(world, {0.0F, 1.0F, 0.0F});
    world.set(inside, Name{"lamp"});
    world.set(block, Name{"block"});
    const auto found = found_in(world);
    REQUIRE(found.size() == 1);
    CHECK(found.front() == EnclosedLight{inside, block});
    CHECK(words_of(world, found) == "lamp is inside block, which lets no light out");
    world.edit<PointLight>(inside, [](PointLight& light) { light.casts_shadow = false; });
    CHECK(found_in(world).empty());
    CHECK(words_of(world, {}).empty());
}

TEST_CASE("a light in an object that is open, seen through or lit from both sides is not enclosed") {
    World world;
    add_mesh(world, room(10.0F));
    add_point_light(world, {0.0F, 0.0F, 0.0F});
    CHECK(found_in(world).empty());
    // Five sides of a cube.
    Mesh open = *cube(0.5F);
    open.primitives[0].indices.resize(30);
    const Entity object = add_mesh(world, std::make_shared<const Mesh>(open));
    CHECK(found_in(world).empty());
    const auto with_material = [&](bool double_sided, AlphaMode alpha) {
        world.set(object, MeshInstance{mesh_of(cube(0.5F)->primitives[0], double_sided, alpha)});
        return found_in(world).size();
    };
    CHECK(with_material(false, AlphaMode::opaque) == 1);
    CHECK(with_material(true, AlphaMode::opaque) == 0);
    CHECK(with_material(false, AlphaMode::blend) == 0);
}

TEST_CASE("the lights of shipped scenes are not enclosed") {
    for (const char* const name : {"cornell", "apartment", "bath", "house", "lamp", "neon", "two-rooms"}) {
        CAPTURE(name);
        const Scene scene = load_scene(shipped_file("scenes", std::string(name) + ".gltf"));
        CHECK(words_of(scene.world, found_in(scene.world)) == "");
    }
}
}  // TEST_SUITE("enclosed lights")

}  // namespace candela::sandbox
