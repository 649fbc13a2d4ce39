#include "renderer/passes/scene/scene_list.hpp"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <candela/scene/scene_error.hpp>
#include "renderer/gpu/log.hpp"
#include "tests/seed.hpp"

TEST_SUITE("scene list") {

using namespace candela;

namespace {

std::shared_ptr<const Mesh> triangle() {
    Primitive primitive{.vertices = {}, .indices = {0, 1, 2}, .material = std::make_shared<const Material>()};
    for (const glm::vec2 corner : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(0, 1)}) {
        Vertex vertex;
        vertex.position = {corner, 0.0F};
        vertex.normal = {0, 0, 1};
        primitive.vertices.push_back(vertex);
    }
    return std::make_shared<const Mesh>(Mesh{"triangle", {std::move(primitive)}});
}

/// Changes a world at random. Parents may form cycles or no longer exist.
class Editor {
 public:
    void edit(World& world) {
        const Entity entity = any(world);
        switch (number(12)) {
            case 0:
                entities_.push_back(world.create());
                world.set(entities_.back(), Transform{.translation = place()});
                return;
            case 1:
                return world.destroy(entity);
            case 2:
            case 3:
            case 4:
                return world.set(entity, MeshInstance{meshes_[number(2)]});
            case 5:
                return world.set(entity, MeshInstance{nullptr});
            case 6:
                return world.remove<MeshInstance>(entity);
            case 7:
                return world.set(entity, DeformedMesh{shapes_[number(2)]});
            case 8:
                return world.remove<DeformedMesh>(entity);
            case 9:
                return world.set(entity, Transform{.translation = place(), .parent = any(world)});
            case 10:
                return world.set(entity, Transform{.translation = broken_place()});
            default:
                return world.set(entity, Transform{.translation = place(), .scale = {mirrored(), 1, 1}});
        }
    }

    [[nodiscard]] std::uint32_t number(std::uint32_t below) {
        return std::uniform_int_distribution<std::uint32_t>(0, below - 1)(engine_);
    }

 private:
    [[nodiscard]] Entity any(World& world) {
        std::erase_if(entities_, [&](Entity entity) { return !world.alive(entity); });
        if (entities_.empty()) {
            entities_.push_back(world.create());
            world.set(entities_.back(), Transform{});
        }
        return entities_[number(static_cast<std::uint32_t>(entities_.size()))];
    }
    [[nodiscard]] glm::vec3 place() { return {static_cast<float>(number(100)), 0.0F, 0.0F}; }
    [[nodiscard]] glm::vec3 broken_place() { return glm::vec3(std::numeric_limits<float>::quiet_NaN()); }
    [[nodiscard]] float mirrored() { return number(2) == 0 ? 1.0F : -1.0F; }

    std::mt19937 engine_{test_seed(17)};
    std::vector<Entity> entities_;
    std::vector<std::shared_ptr<const Mesh>> meshes_{triangle(), triangle()};
    std::vector<std::shared_ptr<const DeformedMesh::Vertices>> shapes_{
        std::make_shared<const DeformedMesh::Vertices>(
            DeformedMesh::Vertices{meshes_[0]->primitives[0].vertices}),
        std::make_shared<const DeformedMesh::Vertices>(
            DeformedMesh::Vertices{meshes_[0]->primitives[0].vertices})};
};

/// Brings a list up to date; returns whether that was possible.
bool updates(SceneList& list, const World& world) {
    try {
        list.update(world);
        return true;
    } catch (const SceneError&) {
        return false;
    }
}

}  // namespace

TEST_CASE("a list that is kept through random edits is the one that a full scan makes") {
    Log log([](std::string_view) {});
    SceneCheck check(log, false);
    SceneList kept(check);
    Editor editor;
    World world;
    World other;  // a copy that goes its own way
    int scans = 0;
    int failures = 0;
    for (int frame = 0; frame < 3000; ++frame) {
        for (std::uint32_t edit = editor.number(6); edit > 0; --edit) editor.edit(world);
        if (editor.number(20) == 0) other = world;
        if (editor.number(50) == 0) std::swap(world, other);
        SceneList scanned(check);
        const bool is_possible = updates(scanned, world);
        REQUIRE(updates(kept, world) == is_possible);
        if (!is_possible) {
            ++failures;
            kept = SceneList(check);
            world = World();
            continue;
        }
        ++scans;
        REQUIRE(kept.geometry() == scanned.geometry());
        REQUIRE(kept.placement() == scanned.placement());
        REQUIRE(kept.geometry().items.size() == world.count<MeshInstance>());
    }
    CHECK(scans > 1000);
    CHECK(failures > 10);  // parents that are gone, and cycles
}

TEST_CASE("what has not changed is shared with the lists before") {
    Log log([](std::string_view) {});
    SceneCheck check(log, true);
    SceneList list(check);
    World world;
    std::vector<Entity> entities;
    const std::shared_ptr<const Mesh> mesh = triangle();
    for (int i = 0; i < 1000; ++i) {
        entities.push_back(world.create());
        world.set(entities.back(), Transform{.translation = {i, 0, 0}});
        world.set(entities.back(), MeshInstance{mesh});
    }
    list.update(world);
    const ScenePlacement before = list.placement();
    world.set(world.create(), Transform{});
    world.set(entities[500], Transform{.translation = {0, 1, 0}});
    list.update(world);
    std::vector<std::size_t> moved;
    std::size_t compared = 0;
    visit_differences(before.world, list.placement().world, [&](std::size_t i) { moved.push_back(i); });
    for (std::size_t i = 0; i < 1000; ++i) compared += &before.world[i] != &list.placement().world[i] ? 1 : 0;
    CHECK(moved == std::vector<std::size_t>{500});
    CHECK(compared == SharedArray<glm::mat4>::block_size);
}

}  // TEST_SUITE("scene list")
