#include "sandbox/scene/studio.hpp"

#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <candela/scene/components.hpp>
#include <candela/scene/deformed_mesh.hpp>
#include <candela/scene/hierarchy.hpp>
#include "sandbox/editing/history.hpp"
#include "sandbox/editing/viewport.hpp"
#include "sandbox/scene/environment.hpp"
#include "sandbox/scene/seen_light.hpp"

namespace candela::sandbox {
namespace {

constexpr float half_turn = std::numbers::pi_v<float>;

/// Brighter than its surroundings above, darker below; at the horizon much darker than what it lights, so
/// that white things are seen before it.
std::shared_ptr<const SkyPicture> studio_picture() {
    constexpr std::uint32_t height = 32, width = 2 * height;
    constexpr float top = 1.0F, horizon = 0.25F, bottom = 0.08F;
    SkyPicture picture{width, height, {}};
    for (std::uint32_t row = 0; row < height; ++row) {
        const float up = std::cos(half_turn * (static_cast<float>(row) + 0.5F) / static_cast<float>(height));
        const float radiance =
            up > 0.0F ? horizon + (top - horizon) * up * up : horizon + (horizon - bottom) * up;
        picture.texels.insert(picture.texels.end(), width, glm::vec3(radiance));
    }
    return std::make_shared<const SkyPicture>(std::move(picture));
}

/// Of a camera's view; horizontal, unit.
glm::vec3 forward_of(const World& world) {
    const std::vector<Entity> all = cameras(world);
    if (all.empty()) return {0.0F, 0.0F, -1.0F};
    const glm::vec3 looks(-world_matrix(world, all.front())[2]);
    const glm::vec3 level(looks.x, 0.0F, looks.z);
    return glm::length(level) > 1e-3F * glm::length(looks) ? glm::normalize(level) : glm::vec3(0, 0, -1);
}

/// The world with the vertices of its deformed meshes in the meshes themselves, where SceneRays finds them.
World with_shapes(const World& world) {
    World shaped = world;
    for (const auto& [entity, instance, deformed] : world.view<MeshInstance, DeformedMesh>()) {
        Mesh mesh = *instance.mesh;
        for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
            mesh.primitives[i].vertices = (*deformed.vertices)[i];
        }
        shaped.set(entity, MeshInstance{std::make_shared<const Mesh>(std::move(mesh))});
    }
    return shaped;
}

}  // namespace

bool is_lit(const World& scene_world) {
    if (scene_world.count<Environment>() + scene_world.count<DirectionalLight>() > 0) return true;
    World world = with_shapes(scene_world);
    tools::SceneRays surfaces;
    const LampLight lamps(world, surfaces);
    EmittedLight emitted(world, surfaces);
    if (!lamps.any() && !emitted.any()) return false;

    surfaces.update_and_wait(world);
    constexpr glm::vec2 size(24.0F);
    const Entity camera = choose_camera(world, std::nullopt, 1.0F);
    const std::vector<tools::SurfaceHit> seen = seen_surfaces(surfaces, make_viewport(world, camera, size));
    // What lamps do not reach is lit by bounces and may be all that is seen but for a spot.
    constexpr float least_share_of_lamps = 0.01F;
    const auto by_lamps = [&](const tools::SurfaceHit& hit) { return lamps.reaches(hit); };
    if (lit_share(seen, by_lamps) >= least_share_of_lamps) return true;
    // A helmet with a glowing visor hardly lights itself, and a lamp mostly the inside of its shade. What is
    // seen of rooms is mostly lit by their lamps, by 0.1 or more.
    constexpr float least = 0.02F;
    constexpr int rays = 8;
    constexpr float least_share_of_emitters = 0.25F;
    const auto by_emitters = [&](const tools::SurfaceHit& hit) {
        return emitted.on_white(hit.point, hit.normal, rays) > least;
    };
    return lit_share(seen, by_emitters) >= least_share_of_emitters;
}

std::vector<Entity> touched_by_studio(Scene& scene) {
    if (scene.studio.empty()) scene.studio = {scene.world.create(), scene.world.create()};
    std::vector<Entity> touched = scene.studio;
    const Entity sky = environment_entity(scene.world);
    if (sky != Entity{} && sky != scene.studio.front()) touched.push_back(sky);
    return touched;
}

void add_studio(Scene& scene) {
    World& world = scene.world;
    const std::vector<Entity> touched = touched_by_studio(scene);
    for (const Entity entity : touched) {
        if (world.has<Environment>(entity)) world.remove<Environment>(entity);
    }
    const Entity sky = scene.studio[0], key = scene.studio[1];
    world.set(sky, Name{"studio sky"});
    world.set(sky, Environment{.radiance = glm::vec3(1.0F), .picture = studio_picture()});
    const glm::vec3 forward = forward_of(world);
    const glm::vec3 right = glm::cross(forward, glm::vec3(0, 1, 0));
    const glm::vec3 shines = glm::normalize(forward + 0.6F * right - glm::vec3(0, 1.2F, 0));
    world.set(key, Name{"studio light"});
    world.set(key, Transform{.rotation = glm::quatLookAt(shines, glm::vec3(0, 1, 0))});
    world.set(key, DirectionalLight{.illuminance = 2.0F});
}

void remove_studio(Scene& scene) {
    for (const Entity entity : scene.studio) set_state(scene.world, entity, {});
}

bool has_studio(const Scene& scene) {
    return !scene.studio.empty() && scene.world.has<DirectionalLight>(scene.studio.back());
}

void light_if_dark(Scene& scene) {
    if (is_lit(scene.world)) return;
    add_studio(scene);
    scene.warnings.emplace_back(
        "the scene has no light that lights what is seen: a studio does, a soft sky and a light");
}

}  // namespace candela::sandbox
