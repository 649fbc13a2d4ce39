#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/ecs/world.hpp"
#include "sandbox/animation.hpp"

namespace candela::sandbox {

/// What the app shows: a world, where it came from, and how it moves.
struct Scene {
    std::filesystem::path path;
    World world;
    std::vector<std::string> warnings;   ///< what the file has and the import left out, a line each
    std::optional<Animation> animation;  ///< of the world
};

/// The file of the scene's script, if it has one.
[[nodiscard]] std::optional<std::string> animation_of(const Scene& scene);

/// A file of a folder that comes with the app, "scenes" or "animations": beside the executable, or, where
/// there is none, in the source tree.
[[nodiscard]] std::filesystem::path shipped_file(const std::string& folder, const std::string& name);

/// Without an animation. Throws SceneError that names the file and the fault.
[[nodiscard]] Scene load_scene(const std::filesystem::path& path);

/// The sphere around the box of all mesh instances, world space, metres. Radius 0 if there is nothing.
struct Bounds {
    glm::vec3 centre{0.0F};
    float radius = 0.0F;
};
[[nodiscard]] Bounds bounds(const World& world);

/// The entities with a Camera, in the order of their creation.
[[nodiscard]] std::vector<Entity> cameras(const World& world);

/// The camera called `wanted`, or, where none has this name, the one of this number from 0 on; without a wish
/// the first. A world without cameras gets one that sees everything at this aspect (width / height). Throws
/// SceneError that lists the cameras if there is no such.
[[nodiscard]] Entity choose_camera(World& world, const std::optional<std::string>& wanted, float aspect);

/// The entity's name, or "entity 3" where it has none.
[[nodiscard]] std::string name_of(const World& world, Entity entity);

}  // namespace candela::sandbox
