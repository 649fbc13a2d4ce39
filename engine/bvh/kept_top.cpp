#include "engine/bvh/kept_top.hpp"

#include <algorithm>
#include <cstddef>
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

/// Half the area of the largest box that build_top has not opened, though it might have been.
float largest_unopened(const TopBvh& top, std::span<const PlacedBvh> objects) {
    float largest = 0.0F;
    for (const TopBvh::Leaf& leaf : top.leaves) {
        const BvhNode& node = objects[leaf.object].bvh->nodes[leaf.node];
        if (node.count == 0) largest = std::max(largest, half_area(node.lower, node.upper));
    }
    return largest;
}

}  // namespace

void KeptTop::build(std::span<const PlacedBvh> objects, std::uint32_t most_opened) {
    top_ = build_top(objects, most_opened);
    built_cost_ = sah_cost(top_.bvh);
    cost_ = 0.0;
    for (const BvhNode& node : top_.bvh.nodes) cost_ += cost_of(node);
    opened_above_ = largest_unopened(top_, objects);
    deepest_object_ = 0;
    for (const PlacedBvh& object : objects) deepest_object_ = std::max(deepest_object_, object.bvh->depth);
    first_leaf_.assign(objects.size(), none);
    link_leaves();
    must_build_ = false;
    all_changed_ = true;
    first_edit_ += edits_.size() + 1;
    edits_.clear();
}

/// Finds the way from objects to their leaves, and from there up.
void KeptTop::link_leaves() {
    const std::vector<BvhNode>& nodes = top_.bvh.nodes;
    parents_.assign(nodes.size() / 2, none);
    node_of_.assign(top_.leaves.size(), none);
    place_of_.assign(top_.leaves.size(), none);
    next_.assign(top_.leaves.size(), none);
    free_leaves_.clear();
    free_pairs_.clear();
    heights_.assign(nodes.size(), 0);
    for (auto i = static_cast<std::uint32_t>(nodes.size()); i-- > 0;) {  // children before their parents
        if (nodes[i].count == 0) {
            parent(nodes[i].first) = i;
            heights_[i] = 1 + std::max(heights_[nodes[i].first], heights_[nodes[i].first + 1]);
        } else {
            const std::uint32_t leaf = top_.bvh.order[nodes[i].first];
            node_of_[leaf] = i;
            place_of_[leaf] = nodes[i].first;
            add_leaf(leaf, top_.leaves[leaf].object);
        }
    }
}

void KeptTop::add_leaf(std::uint32_t leaf, std::uint32_t object) {
    if (object >= first_leaf_.size()) first_leaf_.resize(object + std::size_t{1}, none);
    next_[leaf] = first_leaf_[object];
    first_leaf_[object] = leaf;
}

/// `visit` may take the leaf from its object.
template <class Visit>
void KeptTop::visit_leaves(std::uint32_t object, Visit visit) const {
    const bool is_known = object < first_leaf_.size();
    for (std::uint32_t leaf = is_known ? first_leaf_[object] : none; leaf != none;) {
        visit(std::exchange(leaf, next_[leaf]));
    }
}

void KeptTop::refit(std::span<const PlacedBvh> objects, std::span<const std::uint32_t> changed) {
    for (const std::uint32_t object : changed) {
        visit_leaves(object, [&](std::uint32_t leaf) {
            set_box(node_of_[leaf], box_of(objects[object].bvh->nodes[top_.leaves[leaf].node]));
            note(Edit::Kind::node, node_of_[leaf]);
            fit_above(node_of_[leaf]);
        });
    }
}

void KeptTop::remove(std::uint32_t object) {
    visit_leaves(object, [&](std::uint32_t leaf) { remove_leaf(leaf); });
    if (object < first_leaf_.size()) first_leaf_[object] = none;
}

/// The other child takes the place of the parent. The root's children stay in the first pair.
void KeptTop::remove_leaf(std::uint32_t leaf) {
    const std::uint32_t node = node_of_[leaf];
    must_build_ = must_build_ || node == 0;
    if (must_build_) return;
    note(Edit::Kind::removed_leaf, leaf);
    free_leaves_.push_back(leaf);
    const std::uint32_t above = parent(node);
    const std::uint32_t other = sibling(node);
    cost_ -= cost_of(top_.bvh.nodes[node]);
    if (above != 0) {
        const std::uint32_t pair = top_.bvh.nodes[above].first;
        cost_ -= cost_of(top_.bvh.nodes[above]);
        move_node(other, above);
        free_pair(pair);
        note_wide(above);
        fit_above(above);
        return;
    }
    const BvhNode children = top_.bvh.nodes[other];
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
    top_.bvh.nodes[to] = top_.bvh.nodes[from];
    heights_[to] = heights_[from];
    note(Edit::Kind::node, to);
    link(to);
}

/// Makes what refers to a node that has come to this place refer to it there.
void KeptTop::link(std::uint32_t node) {
    const BvhNode& here = top_.bvh.nodes[node];
    if (here.count == 0) {
        parent(here.first) = node;
        note_wide(here.first);
    } else {
        node_of_[top_.bvh.order[here.first]] = node;
        note_wide(node);
    }
}

void KeptTop::insert(std::span<const PlacedBvh> objects, std::uint32_t object) {
    const Bvh& bvh = *objects[object].bvh;
    if (bvh.nodes.empty()) return;
    const Box box = box_of(bvh.nodes.front());
    // Objects of about the size of others need no build of their own.
    const bool is_large =
        bvh.nodes.front().count == 0 && half_area(box.lower, box.upper) > 2.0F * opened_above_;
    if (must_build_ || is_large || top_.bvh.nodes.size() < 3) {
        must_build_ = true;
        return;
    }
    deepest_object_ = std::max(deepest_object_, bvh.depth);
    // What a new parent of the node and the object costs, or one of the node and so on below it: what boxes
    // grow by, and the new one.
    std::uint32_t at = 0;
    const auto below = [&](std::uint32_t child) {
        const float united = united_area(box_of(top_.bvh.nodes[child]), box);
        return top_.bvh.nodes[child].count > 0 ? united : united - area(child);
    };
    while (top_.bvh.nodes[at].count == 0) {
        const std::uint32_t left = top_.bvh.nodes[at].first;
        const float united = united_area(box_of(top_.bvh.nodes[at]), box);
        const bool goes_left = below(left) <= below(left + 1);
        const float best = goes_left ? below(left) : below(left + 1);
        if (at != 0 && united < united - area(at) + best) break;
        at = goes_left ? left : left + 1;
    }

    const std::uint32_t pair = new_pair();
    const std::uint32_t leaf = new_leaf();
    note(Edit::Kind::node, at);
    note(Edit::Kind::node, pair + 1);
    parent(pair) = at;
    move_node(at, pair);
    top_.leaves[leaf] = {object, 0};
    node_of_[leaf] = pair + 1;
    add_leaf(leaf, object);
    top_.bvh.nodes[pair + 1] = {box.lower, place_of_[leaf], box.upper, 1};
    heights_[pair + 1] = 0;
    cost_ += cost_of(top_.bvh.nodes[pair + 1]) + cost_of(top_.bvh.nodes[pair]) - cost_of(top_.bvh.nodes[at]);
    top_.bvh.nodes[at] = {glm::vec3(0.0F), pair, glm::vec3(0.0F), 0};
    static_cast<void>(fit_to_children(at));
    note_wide(pair);
    fit_above(at);
    for (std::uint32_t node = at; node != 0;) rotate(node = parent(node));
}

/// Exchanges a child of the node with a child of the other one, if what is left of that becomes smaller
/// (Kopta et al., "Fast, Effective BVH Updates for Animated Scenes", 2012). Without it, things that come in
/// rows would make the tree deep.
void KeptTop::rotate(std::uint32_t node) {
    const std::uint32_t left = top_.bvh.nodes[node].first;
    float gained = 0.0F;
    std::uint32_t up = none;  // the grandchild that becomes a child
    for (const std::uint32_t opened : {left, left + 1}) {
        if (top_.bvh.nodes[opened].count > 0) continue;
        const Box other = box_of(top_.bvh.nodes[sibling(opened)]);
        const std::uint32_t first = top_.bvh.nodes[opened].first;
        for (const std::uint32_t grandchild : {first, first + 1}) {
            const Box stays = box_of(top_.bvh.nodes[sibling(grandchild)]);
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
    std::swap(top_.bvh.nodes[a], top_.bvh.nodes[b]);
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
    const auto pair = static_cast<std::uint32_t>(top_.bvh.nodes.size());
    top_.bvh.nodes.resize(pair + std::size_t{2});
    heights_.resize(top_.bvh.nodes.size());
    parents_.push_back(none);
    return pair;
}

void KeptTop::free_pair(std::uint32_t first) {
    top_.bvh.nodes[first] = top_.bvh.nodes[first + 1] = no_node();
    parent(first) = none;
    free_pairs_.push_back(first);
}

std::uint32_t KeptTop::new_leaf() {
    if (!free_leaves_.empty()) {
        const std::uint32_t leaf = free_leaves_.back();
        free_leaves_.pop_back();
        return leaf;
    }
    const auto leaf = static_cast<std::uint32_t>(top_.leaves.size());
    top_.leaves.push_back({});
    place_of_.push_back(static_cast<std::uint32_t>(top_.bvh.order.size()));
    top_.bvh.order.push_back(leaf);
    node_of_.push_back(none);
    next_.push_back(none);
    return leaf;
}

float KeptTop::area(std::uint32_t node) const {
    return half_area(top_.bvh.nodes[node].lower, top_.bvh.nodes[node].upper);
}

void KeptTop::set_box(std::uint32_t node, const Box& box) {
    BvhNode& changed = top_.bvh.nodes[node];
    cost_ -= cost_of(changed);
    changed.lower = box.lower;
    changed.upper = box.upper;
    cost_ += cost_of(changed);
}

/// Returns whether its box or its height has changed.
bool KeptTop::fit_to_children(std::uint32_t node) {
    const std::uint32_t left = top_.bvh.nodes[node].first;
    Box box = box_of(top_.bvh.nodes[left]);
    box.grow(box_of(top_.bvh.nodes[left + 1]));
    const std::uint32_t height = 1 + std::max(heights_[left], heights_[left + 1]);
    if (box == box_of(top_.bvh.nodes[node]) && height == heights_[node]) return false;
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
    if (must_build_ || top_.bvh.nodes.empty()) return true;
    if (heights_[0] + deepest_object_ > bvh_max_depth) return true;
    return cost_ > worn_above * built_cost_ * static_cast<double>(area(0));
}

/// A wide node contains nodes of up to three levels below that which it stands for.
void KeptTop::note_wide(std::uint32_t node) {
    if (all_changed_) return;
    is_noted_.resize(top_.bvh.nodes.size() / 2);
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
    const std::size_t most = std::max<std::size_t>(1024, top_.bvh.nodes.size());
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
    is_noted_.assign(top_.bvh.nodes.size() / 2, false);
    if (std::exchange(all_changed_, top_.bvh.nodes.size() < 3)) return std::nullopt;
    std::ranges::sort(changed);
    return changed;
}

}  // namespace candela
