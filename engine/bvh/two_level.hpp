#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/bvh/box.hpp"
#include "engine/bvh/bvh.hpp"
#include "engine/bvh/wide.hpp"

namespace candela {

// A hierarchy of hierarchies: each object of a scene has its own, over its triangles in world space, and a
// small one, the top, joins them. If an object moves, only its own hierarchy and the top change. In memory
// and for rays, all together are one hierarchy.

/// Maximum depth of an object's hierarchy (`max_depth` of build_bvh). The top may use the rest of
/// `bvh_max_depth`, at least 20 levels.
inline constexpr std::uint32_t object_max_depth = 28;

/// The hierarchy of an object and its place in the joint arrays of wide nodes and triangles.
struct PlacedBvh {
    const Bvh* bvh = nullptr;  ///< empty for an object without triangles
    std::uint32_t first_node = 0;
    std::uint32_t first_triangle = 0;  ///< place of the triangle bvh->order[0]
};

/// The object's nodes in the joint array, from `first_node` on: wide ones, one for each of its inner nodes.
[[nodiscard]] std::vector<WideNode> wide_nodes(const PlacedBvh& object);

/// The top: a hierarchy whose leaves are nodes of objects' hierarchies. Most are their roots. Those of large
/// boxes are opened, that is replaced by their children, so that objects that overlap, such as walls that
/// cross, hardly cost more than in a single hierarchy (Benthin et al., "Improved Two-Level BVHs using Partial
/// Re-Braiding", 2017).
struct TopBvh {
    struct Leaf {
        std::uint32_t object;  ///< index
        std::uint32_t node;    ///< of the object's hierarchy
    };
    std::vector<Leaf> leaves;
    /// Over the boxes of `leaves`, each in a leaf of its own. After edits (see KeptTop) some nodes and leaves
    /// are not in use, and children may come before their parents.
    Bvh bvh;
};

/// Builds the top over the objects; opens at most `most_opened` nodes. O(n log n), deterministic.
[[nodiscard]] TopBvh build_top(std::span<const PlacedBvh> objects, std::uint32_t most_opened = 1024);

/// Whether the place of a node in the top is not in use.
[[nodiscard]] inline bool is_unused(const BvhNode& node) {
    return node.count == 0 && node.first == 0;
}

/// The top's nodes in the joint array, which starts with them. At least one, which has no children if no
/// object has triangles.
[[nodiscard]] std::vector<WideNode> wide_nodes(const TopBvh& top, std::span<const PlacedBvh> objects);
/// One of them; the top must have more than one leaf.
[[nodiscard]] WideNode wide_node_at(const TopBvh& top, std::span<const PlacedBvh> objects,
                                    std::uint32_t index);

/// Like build_bvh for triangles, but over boxes, each in a leaf of its own: `order` has the boxes' indices.
/// There must be at most 2^max_depth boxes.
[[nodiscard]] Bvh build_box_bvh(std::span<const Box> boxes, std::uint32_t max_depth);
/// Fits the hierarchy to other boxes: see refit for triangles.
void refit_box_bvh(Bvh& bvh, std::span<const Box> boxes);

}  // namespace candela
