#include "renderer/passes/view/seen_objects.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include <glm/vec4.hpp>

namespace candela {
namespace {

// Relative slack of clip coordinates, far above the rounding error of the matrix products.
constexpr float rounding = 1e-4F;

/// Signed distances from the six planes of the view volume of a point in clip space, times w; negative:
/// outside.
std::array<float, 6> plane_distances(const glm::vec4& clip) {
    return {clip.w + clip.x, clip.w - clip.x, clip.w + clip.y, clip.w - clip.y, clip.z, clip.w - clip.z};
}

}  // namespace

InView in_view(const Box& box, const glm::mat4& clip_from_box) {
    std::array<bool, 6> all_beyond;
    all_beyond.fill(true);
    bool all_within = true;
    for (unsigned i = 0; i < 8; ++i) {
        const glm::vec4 clip = clip_from_box * glm::vec4(box.corner(i), 1.0F);
        const float slack = rounding * (std::abs(clip.x) + std::abs(clip.y) + std::abs(clip.w));
        const std::array<float, 6> distances = plane_distances(clip);
        for (std::size_t plane = 0; plane < distances.size(); ++plane) {
            all_beyond[plane] = all_beyond[plane] && distances[plane] < -slack;
            all_within = all_within && distances[plane] >= 0.0F;
        }
    }
    if (std::ranges::find(all_beyond, true) != all_beyond.end()) return InView::outside;
    return all_within ? InView::inside : InView::partly;
}

std::vector<std::uint32_t> SeenObjects::update(const KeptTop& top, std::size_t count,
                                               const glm::mat4& clip_from_world, bool other_objects) {
    if (other_objects) seen_.assign(count, false);
    if (other_objects || topology_ != top.topology()) {
        states_.assign(top.top().bvh.nodes.size(), InView::outside);
        leaves_.assign(count, 0);
        touched_.resize(count);
        std::iota(touched_.begin(), touched_.end(), 0U);
    }
    topology_ = top.topology();
    if (!top.top().bvh.nodes.empty()) visit(top.top(), 0, InView::partly, clip_from_world);

    std::vector<std::uint32_t> changed;
    for (const std::uint32_t object : std::exchange(touched_, {})) {
        const bool now = leaves_[object] > 0;
        if (seen_[object] == now) continue;
        seen_[object] = now;
        changed.push_back(object);
    }
    std::ranges::sort(changed);
    return changed;
}

/// `above`: of the node that contains this one.
void SeenObjects::visit(const TopBvh& top, std::uint32_t node, InView above,
                        const glm::mat4& clip_from_world) {
    const BvhNode& box = top.bvh.nodes[node];
    const InView now = above == InView::partly ? in_view({box.lower, box.upper}, clip_from_world) : above;
    const InView before = std::exchange(states_[node], now);
    if (now == before && now != InView::partly) return;
    if (box.count == 0) {
        visit(top, box.first, now, clip_from_world);
        visit(top, box.first + 1, now, clip_from_world);
        return;
    }
    const bool seen = now != InView::outside;
    if (seen == (before != InView::outside)) return;
    const std::uint32_t object = top.leaves[top.bvh.order[box.first]].object;
    leaves_[object] += seen ? 1U : ~0U;
    touched_.push_back(object);
}

}  // namespace candela
