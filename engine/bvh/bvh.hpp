#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace candela {

/// A triangle (metres), in world space unless said otherwise, counter-clockwise from its front.
struct Triangle {
    glm::vec3 a;
    glm::vec3 b;
    glm::vec3 c;
};

/// Node of a binary bounding-volume hierarchy.
/// Inner (`count` == 0): children are nodes `first` and `first + 1`. Leaf: entries [first, first + count) of
/// `Bvh::order`.
struct BvhNode {
    glm::vec3 lower;
    std::uint32_t first;
    glm::vec3 upper;
    std::uint32_t count;
};

/// Maximum depth of a hierarchy: edges from the root to a leaf. Stacks of `traverse` need this many entries.
inline constexpr std::uint32_t bvh_max_depth = 48;

/// Of these, those of a mesh's hierarchy and of the top of a scene's: see engine/bvh/wide.hpp.
inline constexpr std::uint32_t mesh_max_depth = 24;
inline constexpr std::uint32_t top_max_depth = bvh_max_depth - mesh_max_depth;

/// A hierarchy over triangles that it does not own. Empty (no nodes) for no triangles.
struct Bvh {
    /// nodes[0] is the root; at most 2n - 1; siblings are nodes 2i + 1 and 2i + 2, and come after their
    /// parents.
    std::vector<BvhNode> nodes;
    std::vector<std::uint32_t> order;  ///< a permutation of the triangles' indices, leaf by leaf
    std::uint32_t depth = 0;           ///< edges from the root to the deepest leaf
};

/// Points origin + t·direction with t in (t_min, t_max), t_min >= 0; `direction` need not be unit length.
struct Ray {
    glm::vec3 origin;
    glm::vec3 direction;
    float t_min = 0.0F;
    float t_max = std::numeric_limits<float>::infinity();
};

/// Barycentric hit: the point is (1-u-v)·a + u·b + v·c of triangle `triangle` (its index in the caller's
/// span).
struct Hit {
    float t;
    float u;
    float v;
    std::uint32_t triangle;
};

/// Builds by binned surface-area heuristic (Wald, "On fast Construction of SAH-based Bounding Volume
/// Hierarchies", 2007), falling back to median splits where that would exceed `max_depth`. Leaves hold at
/// most 4 triangles. O(n log n), deterministic. A vertex that is not finite affects only the boxes that
/// contain its triangle. There must be fewer than 2^31 triangles, and at most 2^(max_depth + 2).
[[nodiscard]] Bvh build_bvh(std::span<const Triangle> triangles, std::uint32_t max_depth = bvh_max_depth);

/// Fits the boxes to moved triangles and keeps the topology. `triangles` must have the same size as for
/// build_bvh. O(n).
void refit(Bvh& bvh, std::span<const Triangle> triangles);

/// Surface-area estimate of the inner nodes entered plus the triangles tested by a ray that enters the root;
/// 0 if the root has no area. A growing value shows that refitting has degraded the hierarchy.
[[nodiscard]] float sah_cost(const Bvh& bvh);

/// Nearest triangle along the ray, front or back facing. At equal distance the lowest index wins.
[[nodiscard]] std::optional<Hit> closest_hit(const Bvh& bvh, std::span<const Triangle> triangles,
                                             const Ray& ray);

/// Whether the ray hits any triangle.
[[nodiscard]] bool any_hit(const Bvh& bvh, std::span<const Triangle> triangles, const Ray& ray);

/// Ray against one triangle (Möller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997),
/// two-sided. The hit distance is clamped to the part of the ray inside the triangle's box, so that traversal
/// finds exactly what testing every triangle finds.
[[nodiscard]] std::optional<Hit> intersect(const Triangle& triangle, std::uint32_t index, const Ray& ray);

}  // namespace candela
