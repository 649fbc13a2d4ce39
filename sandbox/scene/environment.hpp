#pragma once

#include <filesystem>
#include <variant>

#include <glm/vec3.hpp>

#include <candela/ecs/world.hpp>
#include <candela/scene/components.hpp>
#include "sandbox/scene/scene.hpp"

namespace candela::sandbox {

/// A sky from the command line: the same radiance from everywhere, or a picture.
using SkyChoice = std::variant<glm::vec3, std::filesystem::path>;

/// Radiance of a sky that is added, from everywhere.
inline constexpr glm::vec3 default_sky{0.5F};

/// The entity with the environment that counts; a null entity if there is none.
[[nodiscard]] Entity environment_entity(const World& world);

/// Replaces the environments of the world by this one.
void set_environment(World& world, const Environment& environment);

/// Replaces the environments of the scene by the chosen sky. Throws SceneError that names the file and the
/// problem if its picture cannot be read.
void set_sky(Scene& scene, const SkyChoice& choice);

}  // namespace candela::sandbox
