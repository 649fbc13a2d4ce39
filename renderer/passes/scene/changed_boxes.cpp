#include "renderer/passes/scene/changed_boxes.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "renderer/gpu/growing_buffer.hpp"
#include "shaders/bindings.glsl"

namespace candela {
namespace {

Box around(std::span<const Box> boxes) {
    Box all;
    for (const Box& box : boxes) all.grow(box);
    return all;
}

using Halves = std::pair<std::span<Box>, std::span<Box>>;

/// Halves of the boxes, along the axis in which their centres are farthest apart. Reorders them.
Halves halves(std::span<Box> boxes) {
    Box centres;
    for (const Box& box : boxes) centres.grow(box.lower + box.upper);
    const glm::vec3 size = centres.upper - centres.lower;
    const int longer = size.x >= size.y ? 0 : 1;
    const int axis = size[longer] >= size.z ? longer : 2;
    const std::size_t half = boxes.size() / 2;
    std::ranges::nth_element(boxes, boxes.begin() + static_cast<std::ptrdiff_t>(half), {},
                             [&](const Box& box) { return box.lower[axis] + box.upper[axis]; });
    return {boxes.first(half), boxes.subspan(half)};
}

void add_groups(std::span<Box> boxes, std::size_t most, std::vector<Box>& groups) {
    if (boxes.size() <= most) {
        groups.insert(groups.end(), boxes.begin(), boxes.end());
    } else if (most == 1) {
        groups.push_back(around(boxes));
    } else {
        const Halves parts = halves(boxes);
        add_groups(parts.first, most / 2, groups);
        add_groups(parts.second, most - most / 2, groups);
    }
}

void add_tree(std::span<Box> boxes, float slack, std::vector<gpu::ChangedBox>& tree) {
    const std::size_t place = tree.size();
    const Box all = around(boxes);
    tree.push_back({.lower = all.lower - slack, .next = 0, .upper = all.upper + slack, .pad0 = 0});
    if (boxes.size() > 1) {
        const Halves parts = halves(boxes);
        add_tree(parts.first, slack, tree);
        add_tree(parts.second, slack, tree);
    }
    tree[place].next = static_cast<std::uint32_t>(tree.size());
}

}  // namespace

std::vector<Box> grouped(std::vector<Box> boxes, std::size_t most) {
    if (boxes.size() <= most) return boxes;
    std::vector<Box> groups;
    groups.reserve(most);
    add_groups(boxes, most, groups);
    return groups;
}

std::vector<gpu::ChangedBox> box_tree(std::vector<Box> boxes, float slack) {
    std::vector<gpu::ChangedBox> tree;
    if (boxes.empty()) return tree;
    tree.reserve(2 * boxes.size() - 1);
    add_tree(boxes, slack, tree);
    return tree;
}

ChangedBoxes::ChangedBoxes(FrameGraph& graph, Pass& pass, std::string_view name)
    : tree_(pass.write(growing_buffer<gpu::ChangedBox>(graph, name), {Usage::copy, BINDING_CHANGED_BOXES})) {}

gl::Uniforms ChangedBoxes::upload(const Gpu& gpu, Execution& run,
                                  const std::optional<std::vector<Box>>& boxes, float slack) const {
    const std::vector<gpu::ChangedBox> tree = box_tree(boxes.value_or(std::vector<Box>{}), slack);
    candela::upload<gpu::ChangedBox>(gpu, run, tree_, tree);
    return {{"everything_changed", !boxes.has_value()},
            {"changed_box_count", static_cast<std::uint32_t>(tree.size())}};
}

}  // namespace candela
