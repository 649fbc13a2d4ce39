#include "engine/bvh/two_level.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

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

/// What one of the object's nodes is as a child.
std::uint32_t word_of(const PlacedBvh& object, const BvhNode& node) {
    return node.count == 0 ? child_word(object.first_node + wide_index(node), 0)
                           : child_word(object.first_triangle + node.first, node.count);
}

/// What one of the top's nodes is as a child.
std::uint32_t word_in_top(const TopBvh& top, std::span<const PlacedBvh> objects, const BvhNode& node) {
    if (node.count == 0) return child_word(wide_index(node), 0);
    const TopBvh::Leaf& leaf = top.leaves[top.bvh.order[node.first]];
    return word_of(objects[leaf.object], node_of(leaf, objects));
}

}  // namespace

std::vector<WideNode> wide_nodes(const PlacedBvh& object) {
    std::vector<std::uint32_t> words;
    words.reserve(object.bvh->nodes.size());
    for (const BvhNode& node : object.bvh->nodes) {
        words.push_back(word_of(object, node));
    }
    return widen(*object.bvh, words);
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

WideNode wide_node_at(const TopBvh& top, std::span<const PlacedBvh> objects, std::uint32_t index) {
    const std::uint32_t first = 2 * index + 1;
    if (is_unused(top.bvh.nodes[first])) return {};
    const WideChildren below = wide_children(top.bvh, first);
    std::array<WideChild, 4> children;
    for (std::size_t i = 0; i < below.count; ++i) {
        const BvhNode& node = top.bvh.nodes[below.nodes[i]];
        children[i] = {{node.lower, node.upper}, word_in_top(top, objects, node)};
    }
    return wide_node(std::span(children).first(below.count));
}

std::vector<WideNode> wide_nodes(const TopBvh& top, std::span<const PlacedBvh> objects) {
    if (top.bvh.nodes.empty()) return {wide_node({})};
    const BvhNode& root = top.bvh.nodes.front();
    if (top.bvh.nodes.size() == 1) {
        const WideChild only{{root.lower, root.upper}, word_in_top(top, objects, root)};
        return {wide_node(std::array{only})};
    }
    std::vector<WideNode> wide;
    wide.reserve(top.bvh.nodes.size() / 2);
    for (std::uint32_t i = 0; i < top.bvh.nodes.size() / 2; ++i) {
        wide.push_back(wide_node_at(top, objects, i));
    }
    return wide;
}

}  // namespace candela
