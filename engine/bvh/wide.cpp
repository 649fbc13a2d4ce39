#include "engine/bvh/wide.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>

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

bool is_empty(const Box& box) {
    return box.lower.x > box.upper.x || box.lower.y > box.upper.y || box.lower.z > box.upper.z;
}

Box cut_off(const Box& box) {
    constexpr float most = 0x1p126F;
    return {glm::clamp(box.lower, -most, most), glm::clamp(box.upper, -most, most)};
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

std::vector<WideNode> widen(const Bvh& bvh, std::span<const std::uint32_t> words) {
    std::vector<WideNode> wide;
    wide.reserve(bvh.nodes.size() / 2);
    for (std::uint32_t first = 1; first < bvh.nodes.size(); first += 2) {
        const WideChildren below = wide_children(bvh, first);
        std::array<WideChild, 4> children;
        for (std::size_t i = 0; i < below.count; ++i) {
            const BvhNode& node = bvh.nodes[below.nodes[i]];
            children[i] = {{node.lower, node.upper}, words[below.nodes[i]]};
        }
        wide.push_back(wide_node(std::span(children).first(below.count)));
    }
    return wide;
}

}  // namespace candela
