#include "engine/bvh/kept_top.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

namespace candela {
namespace {

constexpr double worn_above = 1.5;  // times the SAH cost after the last build

Box box_of(const BvhNode& node) {
    return {node.lower, node.upper};
}

float united_area(const Box& a, Box b) {
    b.grow(a);
    return half_area(b.lower, b.upper);
}

/// In places that are not in use.
BvhNode no_node() {
    const Box empty;
    return {empty.lower, 0, empty.upper, 0};
}

/// What a node adds to SAH costs: see sah_cost.
double cost_of(const BvhNode& node) {
    return half_area(node.lower, node.upper) * static_cast<double>(std::max(node.count, 1U));
}

}  // namespace

void KeptTop::build(std::span<const Box> boxes) {
    std::vector<Box> used;
    std::vector<std::uint32_t> objects;  // of `used`
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
        if (is_empty(boxes[i])) continue;
        used.push_back(boxes[i]);
        objects.push_back(i);
    }
    tree_ = build_box_bvh(used, top_max_depth);
    built_cost_ = sah_cost(tree_);
    cost_ = 0.0;
    for (BvhNode& node : tree_.nodes) {
        cost_ += cost_of(node);
        if (node.count > 0) node.first = objects[tree_.order[node.first]];
    }
    link_nodes(boxes.size());
    must_build_ = false;
    all_changed_ = true;
    first_edit_ += edits_.size() + 1;
    edits_.clear();
}

/// Finds the way from objects to their leaves, and from there up.
void KeptTop::link_nodes(std::size_t objects) {
    const std::vector<BvhNode>& nodes = tree_.nodes;
    tree_.order.resize(objects);
    std::iota(tree_.order.begin(), tree_.order.end(), 0U);
    node_of_.assign(objects, none);
    parents_.assign(nodes.size() / 2, none);
    free_pairs_.clear();
    heights_.assign(nodes.size(), 0);
    for (auto i = static_cast<std::uint32_t>(nodes.size()); i-- > 0;) {  // children before their parents
        if (nodes[i].count == 0) {
            parent(nodes[i].first) = i;
            heights_[i] = 1 + std::max(heights_[nodes[i].first], heights_[nodes[i].first + 1]);
        } else {
            node_of_[nodes[i].first] = i;
        }
    }
}

void KeptTop::set(std::uint32_t object, const Box& box) {
    for (auto next = static_cast<std::uint32_t>(node_of_.size()); next <= object; ++next) {
        node_of_.push_back(none);
        tree_.order.push_back(next);
    }
    const std::uint32_t node = node_of_[object];
    if (is_empty(box)) {
        if (node != none) remove(object);
    } else if (node == none) {
        insert(object, box);
    } else {
        set_box(node, box);
        note(Edit::Kind::node, node);
        fit_above(node);
    }
}

/// The other child takes the place of the parent. The root's children stay in the first pair.
void KeptTop::remove(std::uint32_t object) {
    const std::uint32_t node = std::exchange(node_of_[object], none);
    note(Edit::Kind::removed, object);
    must_build_ = must_build_ || node == 0;
    if (must_build_) return;
    const std::uint32_t above = parent(node);
    const std::uint32_t other = sibling(node);
    cost_ -= cost_of(tree_.nodes[node]);
    if (above != 0) {
        const std::uint32_t pair = tree_.nodes[above].first;
        cost_ -= cost_of(tree_.nodes[above]);
        move_node(other, above);
        free_pair(pair);
        note_wide(above);
        fit_above(above);
        return;
    }
    const BvhNode children = tree_.nodes[other];
    if (children.count > 0) {
        must_build_ = true;
        return;
    }
    cost_ -= cost_of(children);
    move_node(children.first, 1);
    move_node(children.first + 1, 2);
    free_pair(children.first);
    static_cast<void>(fit_to_children(0));
    note_wide(1);
    note_wide(2);
}

/// Where it was is not in use then.
void KeptTop::move_node(std::uint32_t from, std::uint32_t to) {
    tree_.nodes[to] = tree_.nodes[from];
    heights_[to] = heights_[from];
    note(Edit::Kind::node, to);
    link(to);
}

/// Makes what refers to a node that has come to this place refer to it there.
void KeptTop::link(std::uint32_t node) {
    const BvhNode& here = tree_.nodes[node];
    if (here.count == 0) {
        parent(here.first) = node;
        note_wide(here.first);
    } else {
        node_of_[here.first] = node;
        note_wide(node);
    }
}

/// The node that becomes the sibling of a new box: that for which boxes grow least, the new parent's
/// included.
std::uint32_t KeptTop::neighbour_for(const Box& box) const {
    // What a new parent of the node and the box costs, or one of the node and so on below it.
    const auto below = [&](std::uint32_t child) {
        const float united = united_area(box_of(tree_.nodes[child]), box);
        return tree_.nodes[child].count > 0 ? united : united - area(child);
    };
    std::uint32_t at = 0;
    while (tree_.nodes[at].count == 0) {
        const std::uint32_t left = tree_.nodes[at].first;
        const float united = united_area(box_of(tree_.nodes[at]), box);
        const bool goes_left = below(left) <= below(left + 1);
        const float best = goes_left ? below(left) : below(left + 1);
        if (at != 0 && united < united - area(at) + best) break;
        at = goes_left ? left : left + 1;
    }
    return at;
}

void KeptTop::insert(std::uint32_t object, const Box& box) {
    must_build_ = must_build_ || tree_.nodes.size() < 3;
    if (must_build_) return;
    const std::uint32_t at = neighbour_for(box);
    const std::uint32_t pair = new_pair();
    note(Edit::Kind::node, at);
    note(Edit::Kind::node, pair + 1);
    parent(pair) = at;
    move_node(at, pair);
    node_of_[object] = pair + 1;
    tree_.nodes[pair + 1] = {box.lower, object, box.upper, 1};
    heights_[pair + 1] = 0;
    cost_ += cost_of(tree_.nodes[pair + 1]) + cost_of(tree_.nodes[pair]) - cost_of(tree_.nodes[at]);
    tree_.nodes[at] = {glm::vec3(0.0F), pair, glm::vec3(0.0F), 0};
    static_cast<void>(fit_to_children(at));
    note_wide(pair);
    fit_above(at);
    for (std::uint32_t node = at; node != 0;) rotate(node = parent(node));
}

/// Exchanges a child of the node with a child of the other one, if what is left of that becomes smaller
/// (Kopta et al., "Fast, Effective BVH Updates for Animated Scenes", 2012). Without it, things that come in
/// rows would make the tree deep.
void KeptTop::rotate(std::uint32_t node) {
    const std::uint32_t left = tree_.nodes[node].first;
    float gained = 0.0F;
    std::uint32_t up = none;  // the grandchild that becomes a child
    for (const std::uint32_t opened : {left, left + 1}) {
        if (tree_.nodes[opened].count > 0) continue;
        const Box other = box_of(tree_.nodes[sibling(opened)]);
        const std::uint32_t first = tree_.nodes[opened].first;
        for (const std::uint32_t grandchild : {first, first + 1}) {
            const Box stays = box_of(tree_.nodes[sibling(grandchild)]);
            const float gain = area(opened) - united_area(stays, other);
            if (gain > gained) {
                gained = gain;
                up = grandchild;
            }
        }
    }
    if (up == none) return;
    const std::uint32_t opened = parent(up);
    swap_nodes(up, sibling(opened));
    static_cast<void>(fit_to_children(opened));
    note_wide(opened);
    fit_above(opened);
}

void KeptTop::swap_nodes(std::uint32_t a, std::uint32_t b) {
    std::swap(tree_.nodes[a], tree_.nodes[b]);
    std::swap(heights_[a], heights_[b]);
    note(Edit::Kind::node, a);
    note(Edit::Kind::node, b);
    link(a);
    link(b);
}

std::uint32_t KeptTop::new_pair() {
    if (!free_pairs_.empty()) {
        const std::uint32_t pair = free_pairs_.back();
        free_pairs_.pop_back();
        return pair;
    }
    const auto pair = static_cast<std::uint32_t>(tree_.nodes.size());
    tree_.nodes.resize(pair + std::size_t{2});
    heights_.resize(tree_.nodes.size());
    parents_.push_back(none);
    return pair;
}

void KeptTop::free_pair(std::uint32_t first) {
    tree_.nodes[first] = tree_.nodes[first + 1] = no_node();
    parent(first) = none;
    free_pairs_.push_back(first);
}

float KeptTop::area(std::uint32_t node) const {
    return half_area(tree_.nodes[node].lower, tree_.nodes[node].upper);
}

void KeptTop::set_box(std::uint32_t node, const Box& box) {
    BvhNode& changed = tree_.nodes[node];
    cost_ -= cost_of(changed);
    changed.lower = box.lower;
    changed.upper = box.upper;
    cost_ += cost_of(changed);
}

/// Returns whether its box or its height has changed.
bool KeptTop::fit_to_children(std::uint32_t node) {
    const std::uint32_t left = tree_.nodes[node].first;
    Box box = box_of(tree_.nodes[left]);
    box.grow(box_of(tree_.nodes[left + 1]));
    const std::uint32_t height = 1 + std::max(heights_[left], heights_[left + 1]);
    if (box == box_of(tree_.nodes[node]) && height == heights_[node]) return false;
    heights_[node] = height;
    set_box(node, box);
    return true;
}

/// Fits what contains a node that has changed.
void KeptTop::fit_above(std::uint32_t node) {
    note_wide(node);
    while (node != 0) {
        node = parent(node);
        if (!fit_to_children(node)) return;
        note_wide(node);
    }
}

bool KeptTop::is_worn() const {
    if (must_build_ || tree_.nodes.empty()) return true;
    if (heights_[0] > top_max_depth) return true;
    return cost_ > worn_above * built_cost_ * static_cast<double>(area(0));
}

/// A wide node contains nodes of up to three levels below that which it stands for.
void KeptTop::note_wide(std::uint32_t node) {
    if (all_changed_) return;
    is_noted_.resize(tree_.nodes.size() / 2);
    for (int level = 0; level < 3 && node != 0; ++level) {
        const std::uint32_t wide = (node - 1) / 2;
        if (!is_noted_[wide]) {
            is_noted_[wide] = true;
            changed_.push_back(wide);
        }
        node = parent(node);
    }
}

void KeptTop::note(Edit::Kind kind, std::uint32_t index) {
    // Who has to follow more than this looks at all nodes.
    const std::size_t most = std::max<std::size_t>(1024, tree_.nodes.size());
    if (edits_.size() >= most) {
        edits_.erase(edits_.begin(), edits_.begin() + static_cast<std::ptrdiff_t>(most / 2));
        first_edit_ += most / 2;
    }
    edits_.push_back({kind, index});
}

std::optional<std::span<const KeptTop::Edit>> KeptTop::edits_since(std::uint64_t revision) const {
    if (revision < first_edit_ || revision > this->revision()) return std::nullopt;
    return std::span(edits_).subspan(revision - first_edit_);
}

std::optional<std::vector<std::uint32_t>> KeptTop::take_changed() {
    std::vector<std::uint32_t> changed = std::exchange(changed_, {});
    is_noted_.assign(tree_.nodes.size() / 2, false);
    if (std::exchange(all_changed_, tree_.nodes.size() < 3)) return std::nullopt;
    std::ranges::sort(changed);
    return changed;
}

}  // namespace candela
