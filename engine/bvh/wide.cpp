#include "engine/bvh/wide.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>

#include <glm/matrix.hpp>

#include "engine/bvh/kept_top.hpp"

namespace candela {
namespace {

constexpr std::uint32_t most_steps = 255;

/// The places along an axis that a node's numbers of steps mean. GPUs find exactly the same ones: a step is a
/// power of two, so that only the sum is rounded.
class Steps {
 public:
    Steps(const Box& around, glm::length_t axis) : origin_(around.lower[axis]) {
        const float lower = origin_;
        const float upper = around.upper[axis];
        if (upper <= lower) return;
        const float least = (upper - lower) / static_cast<float>(most_steps);
        exponent_ = std::max(std::bit_cast<std::uint32_t>(least) >> 23U, 1U);
        while (at(most_steps) < upper) {
            ++exponent_;
        }
    }

    [[nodiscard]] std::uint32_t exponent() const { return exponent_; }
    [[nodiscard]] std::uint32_t last_below(float place) const {
        auto steps = static_cast<std::uint32_t>(std::min(count(place), static_cast<float>(most_steps)));
        while (at(steps) > place) {
            --steps;
        }
        return steps;
    }
    [[nodiscard]] std::uint32_t first_above(float place) const {
        std::uint32_t steps = last_below(place);
        while (at(steps) < place) {
            ++steps;
        }
        return steps;
    }

 private:
    [[nodiscard]] float step() const { return std::bit_cast<float>(exponent_ << 23U); }
    [[nodiscard]] float at(std::uint32_t steps) const { return origin_ + static_cast<float>(steps) * step(); }
    [[nodiscard]] float count(float place) const { return exponent_ > 0 ? (place - origin_) / step() : 0.0F; }

    float origin_;
    std::uint32_t exponent_ = 0;
};

Box cut_off(const Box& box) {
    constexpr float most = 0x1p126F;
    return {glm::clamp(box.lower, -most, most), glm::clamp(box.upper, -most, most)};
}

/// The place of the wide node for an inner node, among those of its hierarchy.
std::uint32_t wide_index(const BvhNode& inner) {
    return (inner.first - 1) / 2;
}

/// What one of a mesh's nodes is as a child.
std::uint32_t word_in_mesh(const BvhNode& node, const MeshPlace& place) {
    return node.count == 0 ? child_word(place.first_node + wide_index(node), 0)
                           : child_word(place.first_triangle + node.first, node.count);
}

/// What one of the top's nodes is as a child.
std::uint32_t word_in_top(const BvhNode& node, std::uint32_t first_instance) {
    return node.count == 0 ? child_word(wide_index(node), 0)
                           : child_word(first_instance + node.first, instance_child);
}

/// The wide node for the inner node whose children are nodes `first` and `first + 1`. `word_of`: of a node
/// of the hierarchy, what it is as a child.
template <class WordOf>
WideNode widened(const Bvh& bvh, std::uint32_t first, WordOf word_of) {
    const WideChildren below = wide_children(bvh, first);
    std::array<WideChild, 4> children;
    for (std::size_t i = 0; i < below.count; ++i) {
        const BvhNode& node = bvh.nodes[below.nodes[i]];
        children[i] = {{node.lower, node.upper}, word_of(node)};
    }
    return wide_node(std::span(children).first(below.count));
}

}  // namespace

WideNode wide_node(std::span<const WideChild> children) {
    Box around;
    for (const WideChild& child : children) {
        if (!is_empty(child.box)) around.grow(cut_off(child.box));
    }
    WideNode node;
    if (is_empty(around)) return node;
    node.origin = around.lower;
    const std::array along{Steps(around, 0), Steps(around, 1), Steps(around, 2)};
    node.exponents = along[0].exponent() | along[1].exponent() << 8U | along[2].exponent() << 16U;
    for (std::uint32_t i = 0; i < children.size(); ++i) {
        if (is_empty(children[i].box)) continue;
        const Box box = cut_off(children[i].box);
        const auto child = static_cast<glm::length_t>(i);
        node.children[child] = children[i].word;
        for (glm::length_t axis = 0; axis < 3; ++axis) {
            const Steps& steps = along[static_cast<std::size_t>(axis)];
            node.lower[axis] |= steps.last_below(box.lower[axis]) << 8U * i;
            node.upper[axis] |= steps.first_above(box.upper[axis]) << 8U * i;
        }
    }
    return node;
}

WideChildren wide_children(const Bvh& bvh, std::uint32_t first) {
    const auto size = [&](std::uint32_t index) {
        const BvhNode& node = bvh.nodes[index];
        return node.count == 0 ? half_area(node.lower, node.upper) : -1.0F;
    };
    WideChildren children{{first, first + 1}, 2};
    while (children.count < children.nodes.size()) {
        const auto end = children.nodes.begin() + static_cast<std::ptrdiff_t>(children.count);
        const auto largest = std::max_element(
            children.nodes.begin(), end, [&](std::uint32_t a, std::uint32_t b) { return size(a) < size(b); });
        if (bvh.nodes[*largest].count > 0) break;
        const std::uint32_t opened = bvh.nodes[*largest].first;
        *largest = opened;
        children.nodes[children.count++] = opened + 1;
    }
    return children;
}

std::uint32_t root_word(const Bvh& mesh, const MeshPlace& place) {
    return word_in_mesh(mesh.nodes.front(), place);
}

std::vector<WideNode> wide_nodes(const Bvh& mesh, const MeshPlace& place) {
    std::vector<WideNode> wide;
    wide.reserve(mesh.nodes.size() / 2);
    for (std::uint32_t first = 1; first < mesh.nodes.size(); first += 2) {
        wide.push_back(widened(mesh, first, [&](const BvhNode& node) { return word_in_mesh(node, place); }));
    }
    return wide;
}

WideNode top_node(const Bvh& top, std::uint32_t first_instance, std::uint32_t index) {
    const std::uint32_t first = 2 * index + 1;
    if (is_unused(top.nodes[first])) return {};
    return widened(top, first, [&](const BvhNode& node) { return word_in_top(node, first_instance); });
}

std::vector<WideNode> top_nodes(const Bvh& top, std::uint32_t first_instance) {
    if (top.nodes.empty()) return {wide_node({})};
    if (top.nodes.size() == 1) {
        const BvhNode& only = top.nodes.front();
        return {
            wide_node(std::array{WideChild{{only.lower, only.upper}, word_in_top(only, first_instance)}})};
    }
    std::vector<WideNode> wide;
    wide.reserve(top.nodes.size() / 2);
    for (std::uint32_t i = 0; i < top.nodes.size() / 2; ++i) wide.push_back(top_node(top, first_instance, i));
    return wide;
}

WideNode instance_node(const glm::mat4& mesh_from_world, std::uint32_t root, std::uint32_t entity) {
    const glm::mat4 rows = glm::transpose(mesh_from_world);
    const auto bits = [](float value) { return std::bit_cast<std::uint32_t>(value); };
    const auto row = [&](glm::length_t i) {
        return glm::uvec4(bits(rows[i].x), bits(rows[i].y), bits(rows[i].z), bits(rows[i].w));
    };
    return {.origin = glm::vec3(rows[0]),
            .exponents = bits(rows[0].w),
            .lower = row(1),
            .upper = row(2),
            .children = {root, entity, 0, 0}};
}

}  // namespace candela
