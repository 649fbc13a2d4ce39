#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <glm/vector_relational.hpp>

#include "engine/bvh/bvh.hpp"

namespace candela {

/// Axis-aligned box, initially empty. NaN coordinates do not grow it.
struct Box {
    glm::vec3 lower{std::numeric_limits<float>::infinity()};
    glm::vec3 upper{-std::numeric_limits<float>::infinity()};

    void grow(const glm::vec3& point) {
        lower = glm::min(lower, point);
        upper = glm::max(upper, point);
    }
    void grow(const Box& box) {
        lower = glm::min(lower, box.lower);
        upper = glm::max(upper, box.upper);
    }
    bool operator==(const Box&) const = default;

    /// Corner 0 to 7: bit 0 of the index selects upper (1) or lower (0) x, bit 1 y, bit 2 z.
    [[nodiscard]] glm::vec3 corner(unsigned index) const {
        return {(index & 1U) != 0 ? upper.x : lower.x, (index & 2U) != 0 ? upper.y : lower.y,
                (index & 4U) != 0 ? upper.z : lower.z};
    }
};

[[nodiscard]] inline Box bounds(const Triangle& triangle) {
    Box box;
    box.grow(triangle.a);
    box.grow(triangle.b);
    box.grow(triangle.c);
    return box;
}

/// Whether a box has no points.
[[nodiscard]] inline bool is_empty(const Box& box) {
    return box.lower.x > box.upper.x || box.lower.y > box.upper.y || box.lower.z > box.upper.z;
}

/// Whether two boxes have points in common, or such that are at most `slack` apart along each axis.
[[nodiscard]] inline bool meet(const Box& a, const Box& b, float slack) {
    return glm::all(glm::lessThanEqual(a.lower, b.upper + slack)) &&
           glm::all(glm::lessThanEqual(b.lower, a.upper + slack));
}

/// Half the surface area; 0 for an empty box.
[[nodiscard]] inline float half_area(const glm::vec3& lower, const glm::vec3& upper) {
    const glm::vec3 size = glm::max(upper - lower, glm::vec3(0.0F));
    return size.x * size.y + size.y * size.z + size.z * size.x;
}

/// Like build_bvh for triangles, but over boxes, each in a leaf of its own: `order` has the boxes' indices.
/// There must be at most 2^max_depth boxes.
[[nodiscard]] Bvh build_box_bvh(std::span<const Box> boxes, std::uint32_t max_depth);
/// Fits the hierarchy to other boxes: see refit for triangles.
void refit_box_bvh(Bvh& bvh, std::span<const Box> boxes);

}  // namespace candela
