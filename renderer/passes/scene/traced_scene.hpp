#pragma once

#include <optional>

#include <glm/vec3.hpp>

#include "engine/bvh/bvh.hpp"
#include "renderer/passes/scene/scene_hierarchy.hpp"
#include "renderer/passes/scene/scene_upload.hpp"

namespace candela {

/// The surfaces that stop light, for rays on the CPU, in world space. Rays pass through the holes of alpha
/// masks, which are read at the nearest texel, without filtering.
struct TracedScene {
    const SceneHierarchy& hierarchy;  ///< of this layout and placement
    const SceneLayout& layout;
    const ScenePlacement& placement;
};

/// Where a ray meets the nearest surface.
struct SurfaceHit {
    float distance;  ///< along the ray, in units of its direction
    glm::vec3 place;
    glm::vec3 normal;  ///< unit, on the side that the ray comes from
};
[[nodiscard]] std::optional<SurfaceHit> nearest_surface(const TracedScene& scene, const Ray& ray);

/// Whether there is a surface between two points.
[[nodiscard]] bool is_blocked(const TracedScene& scene, const glm::vec3& from, const glm::vec3& to);

}  // namespace candela
