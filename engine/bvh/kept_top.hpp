#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "engine/bvh/two_level.hpp"

namespace candela {

/// A top that is kept while objects move, come and go. All that an object costs depends on the depth of the
/// tree, not on the number of the other objects. Inserting after the branch and bound of Omohundro ("Five
/// Balltree Construction Algorithms", 1989), in its greedy form.
class KeptTop {
 public:
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

    /// Something that was changed in the top.
    struct Edit {
        enum class Kind : std::uint8_t {
            node,         ///< another node has come to this place, or it has another box as things have moved
            removed_leaf  ///< the leaf is not in use any more, or in use for another object
        };
        Kind kind;
        std::uint32_t index;  ///< of the node or leaf
    };

    /// As build_top. Objects without a hierarchy have an empty one there.
    void build(std::span<const PlacedBvh> objects, std::uint32_t most_opened = 1024);

    /// Fits the boxes to those of objects whose hierarchies were refitted.
    void refit(std::span<const PlacedBvh> objects, std::span<const std::uint32_t> changed);

    /// Removes all leaves of an object, whose number is free then. Does nothing to one that is not in the
    /// top.
    void remove(std::uint32_t object);
    /// Inserts the root of an object that is not in the top, unless that has no triangles.
    void insert(std::span<const PlacedBvh> objects, std::uint32_t object);

    /// Whether it should be built again: rays have become 1.5 times as expensive as they were after the last
    /// build, it has become too deep for traversals, or an object was inserted that a build would have
    /// opened.
    [[nodiscard]] bool is_worn() const;

    [[nodiscard]] const TopBvh& top() const { return top_; }
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
    void link_leaves();
    void add_leaf(std::uint32_t leaf, std::uint32_t object);
    void remove_leaf(std::uint32_t leaf);
    void move_node(std::uint32_t from, std::uint32_t to);
    void swap_nodes(std::uint32_t a, std::uint32_t b);
    void link(std::uint32_t node);
    void rotate(std::uint32_t node);
    [[nodiscard]] std::uint32_t new_pair();
    void free_pair(std::uint32_t first);
    [[nodiscard]] std::uint32_t new_leaf();
    void set_box(std::uint32_t node, const Box& box);
    [[nodiscard]] bool fit_to_children(std::uint32_t node);
    void fit_above(std::uint32_t node);
    void note_wide(std::uint32_t node);
    void note(Edit::Kind kind, std::uint32_t index);
    template <class Visit>
    void visit_leaves(std::uint32_t object, Visit visit) const;

    TopBvh top_;
    std::vector<std::uint32_t> parents_;     // by pair of siblings: their parent
    std::vector<std::uint32_t> heights_;     // by node: edges to its deepest leaf
    std::vector<std::uint32_t> node_of_;     // by leaf
    std::vector<std::uint32_t> place_of_;    // by leaf: where it is in the order
    std::vector<std::uint32_t> next_;        // by leaf: the next one of its object
    std::vector<std::uint32_t> first_leaf_;  // by object
    std::vector<std::uint32_t> free_leaves_;
    std::vector<std::uint32_t> free_pairs_;  // the first node of each
    double cost_ = 0.0;                      // sum of the terms of sah_cost
    double built_cost_ = 0.0;                // sah_cost after the last build
    float opened_above_ = 0.0F;              // half area of boxes that a build opens
    std::uint32_t deepest_object_ = 0;       // depth of its hierarchy
    std::vector<Edit> edits_;                // the last ones
    std::uint64_t first_edit_ = 0;           // revision before the first of them
    bool must_build_ = false;
    bool all_changed_ = true;
    std::vector<bool> is_noted_;          // by wide node
    std::vector<std::uint32_t> changed_;  // wide nodes
};

}  // namespace candela
