#include "engine/bvh/two_level.hpp"

#include <algorithm>

namespace candela {
namespace {

const BvhNode& node_of(const TopBvh::Leaf& leaf, std::span<const PlacedBvh> objects) {
    return objects[leaf.object].bvh->nodes[leaf.node];
}

std::vector<TopBvh::Leaf> roots_of(std::span<const PlacedBvh> objects) {
    std::vector<TopBvh::Leaf> roots;
    for (std::uint32_t object = 0; object < objects.size(); ++object) {
        if (!objects[object].bvh->nodes.empty()) roots.push_back({object, 0});
    }
    return roots;
}

/// Replaces the inner node with the largest box by its children, `most` times.
void open_largest(std::vector<TopBvh::Leaf>& leaves, std::span<const PlacedBvh> objects, std::uint32_t most) {
    const auto size = [&](const TopBvh::Leaf& leaf) {
        const BvhNode& node = node_of(leaf, objects);
        const float area = half_area(node.lower, node.upper);
        return node.count == 0 && area > 0.0F ? area : 0.0F;  // 0 for those that are not to be opened
    };
    const auto smaller = [&](const TopBvh::Leaf& a, const TopBvh::Leaf& b) { return size(a) < size(b); };
    std::ranges::make_heap(leaves, smaller);
    for (std::uint32_t opened = 0; opened < most && !leaves.empty(); ++opened) {
        if (size(leaves.front()) == 0.0F) return;
        std::ranges::pop_heap(leaves, smaller);
        const auto [object, node] = leaves.back();
        const std::uint32_t child = objects[object].bvh->nodes[node].first;
        leaves.back().node = child;
        std::ranges::push_heap(leaves, smaller);
        leaves.push_back({object, child + 1});
        std::ranges::push_heap(leaves, smaller);
    }
}

std::vector<Box> boxes_of(const std::vector<TopBvh::Leaf>& leaves, std::span<const PlacedBvh> objects) {
    std::vector<Box> boxes;
    boxes.reserve(leaves.size());
    for (const TopBvh::Leaf& leaf : leaves) {
        const BvhNode& node = node_of(leaf, objects);
        boxes.push_back({node.lower, node.upper});
    }
    return boxes;
}

}  // namespace

BvhNode placed(const PlacedBvh& object, BvhNode node) {
    // nodes[1] is at `first_node`.
    node.first += node.count == 0 ? object.first_node - 1 : object.first_triangle;
    return node;
}

TopBvh build_top(std::span<const PlacedBvh> objects, std::uint32_t most_opened) {
    TopBvh top{.leaves = roots_of(objects), .bvh = {}};
    open_largest(top.leaves, objects, most_opened);
    std::uint32_t deepest = 0;
    for (const PlacedBvh& object : objects) {
        deepest = std::max(deepest, object.bvh->depth);
    }
    top.bvh = build_box_bvh(boxes_of(top.leaves, objects), bvh_max_depth - deepest);
    return top;
}

void refit_top(TopBvh& top, std::span<const PlacedBvh> objects) {
    refit_box_bvh(top.bvh, boxes_of(top.leaves, objects));
}

std::vector<BvhNode> joint_nodes(const TopBvh& top, std::span<const PlacedBvh> objects) {
    std::vector<BvhNode> nodes = top.bvh.nodes;
    for (BvhNode& node : nodes) {
        if (node.count > 0) {
            const TopBvh::Leaf& leaf = top.leaves[top.bvh.order[node.first]];
            node = placed(objects[leaf.object], node_of(leaf, objects));
        }
    }
    return nodes;
}

}  // namespace candela
