#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "engine/bvh/box.hpp"
#include "engine/bvh/bvh.hpp"

namespace candela {

/// The hierarchy over the boxes of a scene's objects, kept while they move, come and go. All that an object
/// costs depends on the depth of the tree, not on the number of the other objects. Inserting after the branch
/// and bound of Omohundro ("Five Balltree Construction Algorithms", 1989), in its greedy form.
class KeptTop {
 public:
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

    /// Something that was changed in the top.
    struct Edit {
        enum class Kind : std::uint8_t {
            node,    ///< another node has come to this place, or it has another box as things have moved
            removed  ///< the object is not in the top any more
        };
        Kind kind;
        std::uint32_t index;  ///< of the node or object
    };

    /// Builds the top over the boxes, by object; those that are empty are left out. O(n log n),
    /// deterministic.
    void build(std::span<const Box> boxes);

    /// Fits the tree to an object's box. Inserts an object that was not in the top, and removes one whose box
    /// is empty.
    void set(std::uint32_t object, const Box& box);

    /// Whether it should be built again: rays have become 1.5 times as expensive as they were after the last
    /// build, or it has become too deep for traversals.
    [[nodiscard]] bool is_worn() const;

    /// The hierarchy. Each object has a leaf of its own, whose `first` is the object's number; `order` is the
    /// identity. After edits some nodes are not in use (see is_unused), and children may come before their
    /// parents.
    [[nodiscard]] const Bvh& tree() const { return tree_; }
    /// Counts the changes.
    [[nodiscard]] std::uint64_t revision() const { return first_edit_ + edits_.size(); }
    /// The changes since the revision had this number; nullopt if the top was built since then, or they are
    /// too many. Nodes above those that have changed are left out. Valid until the next change.
    [[nodiscard]] std::optional<std::span<const Edit>> edits_since(std::uint64_t revision) const;
    /// The parent of a node; `none` of the root and of places that are not in use.
    [[nodiscard]] std::uint32_t parent_of(std::uint32_t node) const {
        return node == 0 ? none : parents_[(node - 1) / 2];
    }

    /// The numbers of the wide nodes that may have changed since the last call, ascending; nullopt: any may.
    [[nodiscard]] std::optional<std::vector<std::uint32_t>> take_changed();

 private:
    [[nodiscard]] std::uint32_t& parent(std::uint32_t node) { return parents_[(node - 1) / 2]; }
    /// Siblings are nodes 2i + 1 and 2i + 2.
    [[nodiscard]] static std::uint32_t sibling(std::uint32_t node) {
        return node % 2 == 1 ? node + 1 : node - 1;
    }
    [[nodiscard]] float area(std::uint32_t node) const;
    void link_nodes(std::size_t objects);
    void insert(std::uint32_t object, const Box& box);
    void remove(std::uint32_t object);
    [[nodiscard]] std::uint32_t neighbour_for(const Box& box) const;
    void move_node(std::uint32_t from, std::uint32_t to);
    void swap_nodes(std::uint32_t a, std::uint32_t b);
    void link(std::uint32_t node);
    void rotate(std::uint32_t node);
    [[nodiscard]] std::uint32_t new_pair();
    void free_pair(std::uint32_t first);
    void set_box(std::uint32_t node, const Box& box);
    [[nodiscard]] bool fit_to_children(std::uint32_t node);
    void fit_above(std::uint32_t node);
    void note_wide(std::uint32_t node);
    void note(Edit::Kind kind, std::uint32_t index);

    Bvh tree_;
    std::vector<std::uint32_t> parents_;     // by pair of siblings: their parent
    std::vector<std::uint32_t> heights_;     // by node: edges to its deepest leaf
    std::vector<std::uint32_t> node_of_;     // by object; `none`: it is not in the top
    std::vector<std::uint32_t> free_pairs_;  // the first node of each
    double cost_ = 0.0;                      // sum of the terms of sah_cost
    double built_cost_ = 0.0;                // sah_cost after the last build
    std::vector<Edit> edits_;                // the last ones
    std::uint64_t first_edit_ = 0;           // revision before the first of them
    bool must_build_ = false;
    bool all_changed_ = true;
    std::vector<bool> is_noted_;          // by wide node
    std::vector<std::uint32_t> changed_;  // wide nodes
};

/// Whether the place of a node in a top is not in use.
[[nodiscard]] inline bool is_unused(const BvhNode& node) {
    return node.count == 0 && node.first == 0;
}

}  // namespace candela
