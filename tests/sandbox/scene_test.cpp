#include "sandbox/scene/scene.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <span>
#include <string>

#include <doctest/doctest.h>
#include <glm/vector_relational.hpp>

#include <candela/scene/components.hpp>
#include <candela/scene/scene_error.hpp>
#include "sandbox/editing/viewport.hpp"
#include "tests/engine/world_difference.hpp"
#include "tests/sandbox/temporary_folder.hpp"

namespace candela::sandbox {

TEST_SUITE("scene") {

namespace {

Entity add_camera(World& world, const char* name) {
    const Entity entity = world.create();
    world.set(entity, Name{name});
    world.set(entity, Camera{});
    return entity;
}

/// A triangle with corners at the origin, (size, 0, 0) and (0, 2 size, 0), scaled by 3 along x.
void add_triangle(World& world, float size) {
    const auto mesh = std::make_shared<Mesh>();
    mesh->primitives.emplace_back();
    for (const glm::vec3 corner :
         {glm::vec3(0.0F), glm::vec3(size, 0.0F, 0.0F), glm::vec3(0.0F, 2.0F * size, 0.0F)}) {
        mesh->primitives[0].vertices.push_back({corner, {0.0F, 0.0F, 1.0F}, {}});
    }
    const Entity entity = world.create();
    world.set(entity, Transform{.scale = {3.0F, 1.0F, 1.0F}});
    world.set(entity, MeshInstance{mesh});
}

std::string error_of(World world, const std::string& camera) {
    try {
        static_cast<void>(choose_camera(world, camera, 1.0F));
    } catch (const SceneError& error) {
        return error.what();
    }
    return "none";
}

}  // namespace

TEST_CASE("the shipped scene is found, and has a camera and a light") {
    const Scene scene = load_scene(shipped_file("scenes", "cornell.gltf"));
    CHECK(scene.warnings.empty());
    CHECK(cameras(scene.world).size() == 1);
    CHECK(scene.world.count<PointLight>() == 1);
}

TEST_CASE("a file of the name of a shipped one elsewhere is not shipped") {
    const TemporaryFolder folder;
    const std::filesystem::path shipped = shipped_file("scenes", "cornell.gltf");
    std::filesystem::copy(shipped, folder / "cornell.gltf");
    CHECK(is_shipped("scenes", shipped));
    CHECK_FALSE(is_shipped("scenes", folder / "cornell.gltf"));
    CHECK_FALSE(is_shipped("scenes", folder / "none.gltf"));
}

TEST_CASE("a saved scene opens as it was, without what the app has added for itself") {
    const TemporaryFolder folder;
    Scene scene = load_scene(shipped_file("scenes", "glass.gltf"));
    const Entity lamp = scene.world.create();
    scene.world.set(lamp, Name{"my lamp"});
    scene.world.set(lamp, Transform{.translation = {0.1F, 0.2F, 0.3F}});
    scene.world.set(lamp, SpotLight{.intensity = 3.0F});
    const World before = scene.world;
    const Entity viewer = add_camera(scene.world, "viewer");
    for (const char* name : {"a.gltf", "a.glb"}) {
        CHECK(save_scene(scene.world, folder / name, std::span(&viewer, 1)).empty());
        CHECK(test::difference(load_scene(folder / name).world, before) == "");
    }
}

TEST_CASE("cameras are chosen by name, else by index, else the first") {
    World world;
    const Entity first = add_camera(world, "front");
    const Entity second = add_camera(world, "0");
    CHECK(choose_camera(world, std::nullopt, 1.0F) == first);
    CHECK(choose_camera(world, "front", 1.0F) == first);
    CHECK(choose_camera(world, "1", 1.0F) == second);
    CHECK(choose_camera(world, "0", 1.0F) == second);  // its name
    CHECK(world.count<Camera>() == 2);
}

TEST_CASE("a missing camera is an error that lists the existing ones") {
    World world;
    add_camera(world, "front");
    for (const char* wanted : {"back", "1", "-1", "0x", ""}) {
        const std::string error = error_of(world, wanted);
        CHECK(error.find(std::string("'") + wanted + "'") != std::string::npos);
        CHECK(error.find("'front'") != std::string::npos);
    }
    CHECK(error_of(World(), "0").find("none") != std::string::npos);
}

TEST_CASE("the bounds are those of the meshes in world space") {
    World world;
    CHECK(bounds(world).radius == 0.0F);
    add_triangle(world, 1.0F);
    const Bounds scene = bounds(world);
    CHECK(scene.centre == glm::vec3(1.5F, 1.0F, 0.0F));
    CHECK(scene.radius == doctest::Approx(0.5 * std::sqrt(9.0 + 4.0)));
}

TEST_CASE("a scene without cameras gets one that shows all of its bounds") {
    for (const float aspect : {0.4F, 1.0F, 2.5F}) {
        World world;
        add_triangle(world, 100.0F);
        const Entity camera = choose_camera(world, std::nullopt, aspect);
        const glm::vec2 size(1000.0F * aspect, 1000.0F);
        const Viewport viewport = make_viewport(world, camera, size);
        for (const glm::vec3 corner :
             {glm::vec3(0.0F), glm::vec3(300.0F, 0.0F, 0.0F), glm::vec3(0.0F, 200.0F, 0.0F)}) {
            const auto seen_at = project(viewport, corner);
            REQUIRE(seen_at);
            CHECK(glm::all(glm::greaterThanEqual(*seen_at, glm::vec2(0.0F))));
            CHECK(glm::all(glm::lessThanEqual(*seen_at, size)));
        }
    }
}

TEST_CASE("a file of zeros is an error that names the file and the fault, as is no area a warning") {
    const TemporaryFolder folder;
    for (const char* const name : {"zeros.gltf", "zeros.glb"}) {
        std::ofstream(folder / name) << std::string(4096, '\0');
        const std::string begin =
            (folder / name).string() + ": is no glTF file: it begins with the byte 0x00";
        try {
            static_cast<void>(load_scene(folder / name));
            FAIL("was opened");
        } catch (const SceneError& error) {
            CHECK_MESSAGE(std::string(error.what()).starts_with(begin), error.what());
        }
    }
    // A triangle whose corners are 36 bytes of zeros.
    std::ofstream(folder / "points.gltf") << R"({"asset": {"version": "2.0"}, "scene": 0,
        "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                       "min": [0, 0, 0], "max": [0, 0, 0]}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,)"
                                          << std::string(48, 'A') << R"("}]})";
    const Scene points = load_scene(folder / "points.gltf");
    REQUIRE_FALSE(points.warnings.empty());
    CHECK(points.warnings.front() == why_nothing_is_seen(points));
    CHECK(
        points.warnings.front().starts_with((folder / "points.gltf").string() + ": there is nothing to see"));
    CHECK(why_nothing_is_seen(load_scene(shipped_file("scenes", "cornell.gltf"))).empty());
}
}  // TEST_SUITE("scene")

}  // namespace candela::sandbox
