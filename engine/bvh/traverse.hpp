#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include <glm/vec3.hpp>

#include "engine/bvh/bvh.hpp"

namespace candela {

namespace detail {

// Relative margin of a box's interval on the ray. Rounding needs 4e-7 (Ize, "Robust BVH Ray Traversal",
// 2013); division on a GPU, with an error of up to 2.5 units in the last place, needs about as much in
// addition.
inline constexpr float slack = 1.00001F;

struct Interval {
    float near;
    float far;

    [[nodiscard]] bool empty() const { return !(near <= far * slack); }
};

// The part of the ray in a box, by slabs (Kay and Kajiya, "Ray Tracing Complex Scenes", 1986). Per axis,
//     enter = (plane met first - origin) / direction,  exit = (the other plane - origin) / direction,
// and near and far are the latest entry and the earliest exit. Where direction is 0, IEEE division makes them
// -∞ or +∞, depending on whether the origin is between the planes. An origin on a plane gives 0 · ∞ = NaN:
// the comparisons are written so that NaN does not restrict the interval. Every step is monotonic, so the
// interval in a box contains the interval in each box inside it, also with rounding.
class Slabs {
 public:
    explicit Slabs(const Ray& ray)
        : origin_(ray.origin), inverse_(1.0F / ray.direction), whole_{ray.t_min, ray.t_max} {}

    [[nodiscard]] Interval operator()(const glm::vec3& lower, const glm::vec3& upper) const {
        Interval inside = whole_;
        for (glm::length_t axis = 0; axis < 3; ++axis) {
            const float to_lower = (lower[axis] - origin_[axis]) * inverse_[axis];
            const float to_upper = (upper[axis] - origin_[axis]) * inverse_[axis];
            const bool forwards = inverse_[axis] >= 0.0F;
            const float enter = forwards ? to_lower : to_upper;
            const float exit = forwards ? to_upper : to_lower;
            inside.near = enter > inside.near ? enter : inside.near;
            inside.far = exit < inside.far ? exit : inside.far;
        }
        return inside;
    }

 private:
    glm::vec3 origin_;
    glm::vec3 inverse_;
    Interval whole_;
};

// A node to visit, and the distance at which the ray enters it; +∞ if it misses the node.
struct Entry {
    std::uint32_t node;
    float near;
};

inline Entry enter(const Bvh& bvh, std::uint32_t node, const Slabs& slabs) {
    const Interval inside = slabs(bvh.nodes[node].lower, bvh.nodes[node].upper);
    return {node, inside.empty() ? std::numeric_limits<float>::infinity() : inside.near};
}

}  // namespace detail

/// Calls `visit(index)` for each entry of `Bvh::order` (a triangle, or a box of build_box_bvh) that the ray
/// may hit, roughly from near to far. `visit` returns the distance beyond which entries can be skipped, in
/// units of the ray's direction. Only the entries below node `root` are visited.
template <class Visit>
void traverse(const Bvh& bvh, const Ray& ray, Visit&& visit, std::uint32_t root = 0) {
    if (bvh.nodes.empty()) return;
    const detail::Slabs slabs(ray);
    float limit = std::min(ray.t_max, std::numeric_limits<float>::max());  // finite, so that it excludes +∞
    // Each inner node on the way down puts at most its farther child on the stack, and there are at most
    // `bvh_max_depth` inner nodes above a leaf.
    std::array<detail::Entry, bvh_max_depth> stack{};
    std::size_t waiting = 0;
    detail::Entry current = detail::enter(bvh, root, slabs);
    while (true) {
        const BvhNode& node = bvh.nodes[current.node];
        if (current.near <= limit && node.count == 0) {
            detail::Entry nearer = detail::enter(bvh, node.first, slabs);
            detail::Entry farther = detail::enter(bvh, node.first + 1, slabs);
            if (farther.near < nearer.near) std::swap(nearer, farther);
            if (farther.near <= limit) stack[waiting++] = farther;
            current = nearer;
            continue;
        }
        for (std::uint32_t i = 0; i < node.count && current.near <= limit; ++i) {
            limit = std::min(limit, visit(bvh.order[node.first + i]));
        }
        if (waiting == 0) return;
        current = stack[--waiting];
    }
}

}  // namespace candela
