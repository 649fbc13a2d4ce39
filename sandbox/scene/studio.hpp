#pragma once

#include <vector>

#include <candela/ecs/world.hpp>
#include "sandbox/scene/scene.hpp"

namespace candela::sandbox {

/// An entity with a mesh, and how much of what surfaces of the world emit arrives there.
struct LitObject {
    Entity entity;
    double area = 0.0;      ///< m²
    double radiance = 0.0;  ///< that it would have on average if it were white, without bounces; cd/m²
};

/// All objects of a world that has surfaces which emit light; else none. By 1,024 rays, the same at each
/// call. Of textures, the mean counts.
[[nodiscard]] std::vector<LitObject> light_by_emission(const World& world);

/// Whether a world has a light, a sky, or surfaces that emit so much that objects with a third of all surface
/// are lit by it.
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
