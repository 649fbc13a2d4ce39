#pragma once

#include <vector>

#include <candela/ecs/world.hpp>
#include "sandbox/scene/scene.hpp"

namespace candela::sandbox {

/// Whether a world has a sky, a directional light, a lamp that reaches a hundredth of what is seen of it, or
/// surfaces that emit so much that a quarter of what is seen is lit by them; seen from its first camera, or,
/// without one, from where the app looks at it.
[[nodiscard]] bool is_lit(const World& world);

/// Replaces the sky of a scene by one that is brighter above than below, and adds a directional light with a
/// shadow: it comes from the left above the first camera, or above one that looks along -Z. The entities are
/// Scene::studio.
void add_studio(Scene& scene);

/// Takes the components of Scene::studio; the entities stay for undoing.
void remove_studio(Scene& scene);

/// Whether the light of the studio is there.
[[nodiscard]] bool has_studio(const Scene& scene);

/// The entities that add_studio and remove_studio change: those of the studio, and the one with the sky.
[[nodiscard]] std::vector<Entity> touched_by_studio(Scene& scene);

/// add_studio for a scene that is not lit, with a line for its warnings.
void light_if_dark(Scene& scene);

}  // namespace candela::sandbox
