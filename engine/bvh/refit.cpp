#include <algorithm>

#include "engine/bvh/box.hpp"
#include "engine/bvh/bvh.hpp"

namespace candela {

namespace {

/// `bounds_of(i)`: the box around what entry i of the order stands for.
template <class BoundsOf>
void fit(Bvh& bvh, BoundsOf bounds_of) {
    // Children come after their parents, so going backwards updates the children first.
    for (auto at = bvh.nodes.rbegin(); at != bvh.nodes.rend(); ++at) {
        BvhNode& node = *at;
        Box box;
        for (std::uint32_t i = 0; i < node.count; ++i) {
            box.grow(bounds_of(bvh.order[node.first + i]));
        }
        if (node.count == 0) {
            const BvhNode& left = bvh.nodes[node.first];
            const BvhNode& right = bvh.nodes[node.first + 1];
            box = {glm::min(left.lower, right.lower), glm::max(left.upper, right.upper)};
        }
        node.lower = box.lower;
        node.upper = box.upper;
    }
}

}  // namespace

void refit(Bvh& bvh, std::span<const Triangle> triangles) {
    fit(bvh, [&](std::uint32_t i) { return bounds(triangles[i]); });
}

void refit_box_bvh(Bvh& bvh, std::span<const Box> boxes) {
    fit(bvh, [&](std::uint32_t i) { return boxes[i]; });
}

float sah_cost(const Bvh& bvh) {
    if (bvh.nodes.empty()) return 0.0F;
    const BvhNode& root = bvh.nodes.front();
    const double root_area = half_area(root.lower, root.upper);
    if (!(root_area > 0.0)) return 0.0F;
    double cost = 0.0;
    for (const BvhNode& node : bvh.nodes) {
        cost += half_area(node.lower, node.upper) * static_cast<double>(std::max(node.count, 1U));
    }
    return static_cast<float>(cost / root_area);
}

}  // namespace candela
