#pragma once

#include <cstdint>
#include <limits>
#include <vector>

namespace candela {

/// Which entities have which one as their parent, by the entities' indices. All changes take constant time.
class ChildLinks {
 public:
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

    /// `parent`: an index, or `none`.
    void set_parent(std::uint32_t child, std::uint32_t parent) {
        if (child >= links_.size()) {
            if (parent == none) return;
            links_.resize(child + std::size_t{1});
        }
        if (links_[child].parent == parent) return;
        unlink(child);
        if (parent == none) return;
        if (parent >= links_.size()) links_.resize(parent + std::size_t{1});
        link(child, parent);
    }

    /// Calls `visit(index)` for each child of the entity with this index. `visit` must not change parents.
    template <class Visit>
    void visit_children(std::uint32_t parent, Visit visit) const {
        if (parent >= links_.size()) return;
        for (std::uint32_t at = links_[parent].first_child; at != none; at = links_[at].next) visit(at);
    }

 private:
    /// The children of an entity are a list that is linked in both directions.
    struct Links {
        std::uint32_t parent = none;
        std::uint32_t first_child = none;
        std::uint32_t next = none;
        std::uint32_t before = none;
    };

    void link(std::uint32_t child, std::uint32_t parent) {
        Links& links = links_[child];
        links.parent = parent;
        links.before = none;
        links.next = links_[parent].first_child;
        if (links.next != none) links_[links.next].before = child;
        links_[parent].first_child = child;
    }

    void unlink(std::uint32_t child) {
        Links& links = links_[child];
        if (links.parent == none) return;
        if (links.before != none) {
            links_[links.before].next = links.next;
        } else {
            links_[links.parent].first_child = links.next;
        }
        if (links.next != none) links_[links.next].before = links.before;
        links.parent = links.next = links.before = none;
    }

    std::vector<Links> links_;
};

}  // namespace candela
