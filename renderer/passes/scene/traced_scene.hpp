#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

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

/// By drawable: its index among the solid ones, in the order of SceneLayout::visit_solids.
[[nodiscard]] std::vector<std::uint32_t> order_of_solids(const SceneLayout& layout);

/// A point on a side of a triangle.
struct LayerPoint {
    glm::vec3 position;
    glm::vec3 normal;        ///< unit
    std::uint32_t solid;     ///< its drawable, by order_of_solids
    std::uint32_t triangle;  ///< of the drawable
};
/// When surfaces that lie on each other are one.
struct LayerLimits {
    float reach = 0.0F;  ///< metres, most between them
    float tie = 0.0F;    ///< metres: rounding may decide which is in front of one that is nearer
};
/// Whether another surface lies on a point. It faces the same way and is in front of it, or where that is a
/// tie, comes first. `order`: order_of_solids.
[[nodiscard]] bool is_covered(const TracedScene& scene, std::span<const std::uint32_t> order,
                              const LayerPoint& point, const LayerLimits& limits);

/// Whether there is a surface between two points.
[[nodiscard]] bool is_blocked(const TracedScene& scene, const glm::vec3& from, const glm::vec3& to);

}  // namespace candela
