#include "sandbox/scene/studio.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <memory>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <candela/scene/components.hpp>
#include <candela/scene/deformed_mesh.hpp>
#include <candela/scene/hierarchy.hpp>
#include "sandbox/editing/history.hpp"
#include "sandbox/scene/seen_light.hpp"
#include "tests/sandbox/temporary_folder.hpp"

TEST_SUITE("studio") {

using namespace candela;
using namespace candela::sandbox;

namespace {

/// A square of this half width in the plane y = 0, whose front is up.
std::shared_ptr<const Mesh> square(float half, float emissive) {
    Material material;
    material.emissive = glm::vec3(emissive);
    Primitive primitive;
    primitive.material = std::make_shared<const Material>(std::move(material));
    for (const glm::vec2 corner : {glm::vec2(-1, -1), glm::vec2(-1, 1), glm::vec2(1, 1), glm::vec2(1, -1)}) {
        Vertex vertex;
        vertex.position = {half * corner.x, 0.0F, half * corner.y};
        vertex.normal = {0, 1, 0};
        primitive.vertices.push_back(vertex);
    }
    primitive.indices = {0, 1, 2, 0, 2, 3};
    return std::make_shared<const Mesh>(Mesh{.name = {}, .primitives = {std::move(primitive)}});
}

Entity add(World& world, std::shared_ptr<const Mesh> mesh, const Transform& transform) {
    const Entity entity = world.create();
    world.set(entity, transform);
    world.set(entity, MeshInstance{std::move(mesh)});
    return entity;
}

Scene shipped(const char* name) {
    return load_scene(shipped_file("scenes", name));
}

glm::vec3 shines(const World& world, Entity light) {
    return -glm::vec3(world_matrix(world, light)[2]);
}

}  // namespace

TEST_CASE("a scene without light is shown in a studio, and a warning says so") {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder / "dark.gltf";
    std::ofstream(path) << R"({"asset": {"version": "2.0"}, "scenes": [{}]})";
    Scene scene = load_scene(path);
    const std::size_t warnings = scene.warnings.size();
    light_if_dark(scene);
    CHECK(scene.warnings.size() == warnings + 1);
    CHECK(has_studio(scene));
    CHECK(scene.world.count<Environment>() == 1);
    CHECK(scene.world.count<DirectionalLight>() == 1);
}

TEST_CASE("a scene that a light, a surface or the sky lights stays as it is") {
    for (const char* lit : {"cornell.gltf", "corner.gltf", "lamp.gltf", "neon.gltf", "court.gltf"}) {
        CAPTURE(lit);
        Scene scene = shipped(lit);
        const std::size_t skies = scene.world.count<Environment>();
        light_if_dark(scene);
        CHECK(scene.warnings.empty());
        CHECK(!has_studio(scene));
        CHECK(scene.world.count<Environment>() == skies);
    }
}

TEST_CASE("a helmet with glowing slits does not light itself, and rooms are lit by their lamps") {
    for (const char* name : {"lamp.gltf", "neon.gltf", "bath.gltf"}) {
        CAPTURE(name);
        CHECK(is_lit(shipped(name).world));
    }
    Scene helmet = shipped("helmet.gltf");
    for (const Entity sky : touched_by_studio(helmet)) set_state(helmet.world, sky, {});
    for_each_light_kind([&]<class Light>(const LightTraits<Light>&) {
        std::vector<Entity> all;
        for (const auto& [entity, light] : helmet.world.view<Light>()) all.push_back(entity);
        for (const Entity entity : all) helmet.world.remove<Light>(entity);
    });
    CHECK(EmittedLight(helmet.world, tools::SceneRays{}).any());
    light_if_dark(helmet);
    CHECK(has_studio(helmet));
}

TEST_CASE("a point above a square is lit by L F") {
    // Of an area element that faces the centre of a square of 2 m × 2 m at a distance of 2 m: F = 0.2394
    // (Howell, "A Catalog of Radiation Heat Transfer Configuration Factors", B-4, four times with A = B =
    // 0.5).
    World world;
    add(world, square(1.0F, 3.0F), Transform{});
    tools::SceneRays surfaces;
    surfaces.update_and_wait(world);
    EmittedLight light(world, surfaces);
    // The deviation of a ray is below the mean, so that of 4,096 is below 1.6 %.
    CHECK(light.on_white({0, 2, 0}, {0, -1, 0}, 4096) == doctest::Approx(3.0 * 0.2394).epsilon(0.05));
    CHECK(light.on_white({0, 2, 0}, {0, 1, 0}, 64) == 0.0F);
    CHECK(light.on_white({0, -2, 0}, {0, 1, 0}, 64) == 0.0F);
}

TEST_CASE("a lamp that only its own bulb sees lights no scene") {
    // A square that glows downwards onto a floor that is seen from above, then onto one just below it.
    World world;
    add(world, square(0.5F, 3.0F),
        Transform{.translation = {0, 2, 0},
                  .rotation = glm::angleAxis(std::numbers::pi_v<float>, glm::vec3(1, 0, 0))});
    add(world, square(3.0F, 0.0F), Transform{});
    CHECK(is_lit(world));
    add(world, square(0.6F, 0.0F), Transform{.translation = {0, 1.99F, 0}});
    CHECK(!is_lit(world));
}

TEST_CASE("a lamp lights a scene if it reaches what is seen") {
    // A floor that is seen from above, below a spot light.
    const auto lit = [](const SpotLight& light, const Transform& place) {
        World world;
        add(world, square(3.0F, 0.0F), Transform{});
        const Entity lamp = world.create();
        world.set(lamp, place);
        world.set(lamp, light);
        return is_lit(world);
    };
    const glm::quat down = glm::angleAxis(-0.5F * std::numbers::pi_v<float>, glm::vec3(1, 0, 0));
    CHECK(lit({}, {.translation = {0, 2, 0}, .rotation = down}));
    CHECK(!lit({}, {.translation = {0, 2, 0}, .rotation = glm::inverse(down)}));
    CHECK(!lit({}, {.translation = {0, -2, 0}, .rotation = glm::inverse(down)}));
    CHECK(!lit({.range = 1.9F}, {.translation = {0, 2, 0}, .rotation = down}));
    CHECK(!lit({.intensity = 0.0F}, {.translation = {0, 2, 0}, .rotation = down}));
    // The cone's spot on the floor has a radius of 6 cm: less than a thousandth of what is seen.
    CHECK(!lit({.outer_cone = 0.03F}, {.translation = {0, 2, 0}, .rotation = down}));
}

TEST_CASE("a lamp inside a closed thing lights no scene") {
    World world = shipped("cornell.gltf").world;
    CHECK(is_lit(world));
    visit_lights(World(world), [&]<class Light>(Entity entity, const Light&) {
        world.edit<Transform>(entity, [](Transform& place) { place.translation = {0.33F, 0.3F, 0.39F}; });
    });
    CHECK(!is_lit(world));
}

TEST_CASE("whether a lamp reaches a deformed mesh depends on where its vertices are now") {
    World world;
    const std::shared_ptr<const Mesh> mesh = square(3.0F, 0.0F);
    const Entity floor = add(world, mesh, Transform{.translation = {0, 3, 0}});
    const Entity lamp = world.create();
    world.set(lamp, Transform{.translation = {0, 2, 0}});
    world.set(lamp, PointLight{});
    CHECK(!is_lit(world));
    DeformedMesh::Vertices lower{mesh->primitives.front().vertices};
    for (Vertex& vertex : lower.front()) vertex.position.y -= 3.0F;
    world.set(floor, DeformedMesh{std::make_shared<const DeformedMesh::Vertices>(std::move(lower))});
    CHECK(is_lit(world));
}

TEST_CASE("what shines into the open, or from the back of a surface, lights nothing") {
    World world;
    add(world, square(1.0F, 3.0F), Transform{});
    add(world, square(5.0F, 0.0F), Transform{.translation = {0, -1, 0}});
    CHECK(!is_lit(world));
}

TEST_CASE("the studio's light comes from the left above the camera") {
    for (const float turned : {0.0F, 1.0F, 2.5F}) {
        CAPTURE(turned);
        Scene scene{"", {}, {}, {}};
        const glm::quat rotation = glm::angleAxis(turned, glm::vec3(0, 1, 0));
        const Entity camera = scene.world.create();
        scene.world.set(camera, Transform{.rotation = rotation});
        scene.world.set(camera, Camera{});
        add_studio(scene);
        const glm::vec3 in_view = glm::inverse(rotation) * shines(scene.world, scene.studio[1]);
        CHECK(in_view.x > 0.2F);
        CHECK(in_view.y < -0.5F);
        CHECK(in_view.z < -0.2F);
    }
}

TEST_CASE("a camera that looks straight down has a light from above, too") {
    Scene scene{"", {}, {}, {}};
    const Entity camera = scene.world.create();
    scene.world.set(
        camera, Transform{.rotation = glm::angleAxis(-0.5F * std::numbers::pi_v<float>, glm::vec3(1, 0, 0))});
    scene.world.set(camera, Camera{});
    add_studio(scene);
    CHECK(shines(scene.world, scene.studio[1]).y < -0.5F);
}

TEST_CASE("white things differ from the studio's background, and their sides from each other") {
    Scene scene{"", {}, {}, {}};
    add_studio(scene);
    const Environment sky = environment_of(scene.world);
    const glm::vec3 to_light = -shines(scene.world, scene.studio[1]);
    const float illuminance = scene.world.get<DirectionalLight>(scene.studio[1]).illuminance;
    // Radiance of a white surface: light of the key, and of the texels of the sky.
    const auto white = [&](glm::vec3 normal) {
        constexpr double pi = std::numbers::pi;
        double sum = static_cast<double>(illuminance * std::max(glm::dot(normal, to_light), 0.0F)) / pi;
        const SkyPicture& picture = *sky.picture;
        for (std::uint32_t y = 0; y < picture.height; ++y) {
            const double solid_angle =
                2.0 * pi / picture.width *
                (std::cos(pi * y / picture.height) - std::cos(pi * (y + 1) / picture.height));
            for (std::uint32_t x = 0; x < picture.width; ++x) {
                const glm::vec3 direction =
                    sky_direction((glm::vec2(x, y) + 0.5F) / glm::vec2(picture.width, picture.height));
                const auto cosine = static_cast<double>(std::max(glm::dot(normal, direction), 0.0F));
                sum +=
                    static_cast<double>(picture.texels[y * picture.width + x].r) * solid_angle * cosine / pi;
            }
        }
        return sum;
    };
    const auto horizon =
        static_cast<double>(sky.picture->texels[std::size_t{sky.picture->height / 2} * sky.picture->width].r);
    const double top = white({0, 1, 0}), front = white({0, 0, 1}), left = white({-1, 0, 0}),
                 right = white({1, 0, 0});
    for (const double side : {top, front, left}) CHECK(side > 2.0 * horizon);
    CHECK(top > 1.2 * front);
    CHECK(front > 1.2 * left);
    CHECK(left > 1.2 * right);
    CHECK(right > 1.2 * white({0, -1, 0}));
}

TEST_CASE("the studio comes and goes as one edit") {
    Scene scene = shipped("court.gltf");
    const Environment before = environment_of(scene.world);
    History history;
    EntityStates states = states_of(scene.world, touched_by_studio(scene));
    add_studio(scene);
    history.record(scene.world, "add the studio", std::move(states));
    CHECK(has_studio(scene));
    CHECK(scene.world.count<Environment>() == 1);
    history.undo(scene.world);
    CHECK(!has_studio(scene));
    CHECK(environment_of(scene.world).picture == before.picture);
    history.redo(scene.world);
    CHECK(has_studio(scene));
    remove_studio(scene);
    CHECK(!has_studio(scene));
    CHECK(scene.world.count<Environment>() == 0);
    add_studio(scene);
    CHECK(has_studio(scene));
}

}  // TEST_SUITE("studio")
