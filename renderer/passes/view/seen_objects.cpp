#include "renderer/passes/view/seen_objects.hpp"

#include <algorithm>
#include <array>
#include <cmath>
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
                                               const glm::mat4& clip_from_world) {
    seen_.resize(std::max(count, seen_.size()));
    reported_.resize(seen_.size());
    follow(top);
    const bool same_view = std::exchange(clip_from_world_, clip_from_world) == clip_from_world;
    if (!top.tree().nodes.empty()) visit(top.tree(), 0, InView::partly, same_view);

    std::ranges::sort(touched_);
    touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
    std::vector<std::uint32_t> changed;
    for (const std::uint32_t object : std::exchange(touched_, {})) {
        if (reported_[object] != seen_[object]) changed.push_back(object);
        reported_[object] = seen_[object];
    }
    return changed;
}

/// Takes over what has changed in the top.
void SeenObjects::follow(const KeptTop& top) {
    const auto edits = top.edits_since(revision_);
    revision_ = top.revision();
    states_.resize(top.tree().nodes.size(), std::nullopt);
    if (!edits) {
        for (std::uint32_t object = 0; object < seen_.size(); ++object) set_seen(object, false);
        std::ranges::fill(states_, std::nullopt);
        return;
    }
    for (const KeptTop::Edit& edit : *edits) {
        if (edit.kind == KeptTop::Edit::Kind::node) {
            forget(top, edit.index);
        } else {
            set_seen(edit.index, false);
        }
    }
}

/// The way to the node is then visited, too.
void SeenObjects::forget(const KeptTop& top, std::uint32_t node) {
    states_[node] = std::nullopt;
    for (std::uint32_t above = top.parent_of(node); above != KeptTop::none && states_[above];
         above = top.parent_of(above)) {
        states_[above] = std::nullopt;
    }
}

void SeenObjects::visit(const Bvh& top, std::uint32_t node, InView above, bool same_view) {
    const BvhNode& box = top.nodes[node];
    const InView now = above == InView::partly ? in_view({box.lower, box.upper}, clip_from_world_) : above;
    const std::optional<InView> before = std::exchange(states_[node], now);
    if (now == before && (same_view || now != InView::partly)) return;
    if (box.count > 0) return set_seen(box.first, now != InView::outside);
    visit(top, box.first, now, same_view);
    visit(top, box.first + 1, now, same_view);
}

void SeenObjects::set_seen(std::uint32_t object, bool is_seen) {
    if (seen_[object] == is_seen) return;
    seen_[object] = is_seen;
    touched_.push_back(object);
}

}  // namespace candela
