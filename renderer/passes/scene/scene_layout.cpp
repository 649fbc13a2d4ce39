#include "renderer/passes/scene/scene_layout.hpp"

#include <algorithm>

namespace candela {

std::span<const SceneLayout::Group> SceneLayout::groups_of(AlphaMode alpha) const {
    const auto alpha_of = [](const Group& group) { return group.material->alpha; };
    return {std::ranges::lower_bound(groups, alpha, {}, alpha_of),
            std::ranges::upper_bound(groups, alpha, {}, alpha_of)};
}

std::span<const Vertex> vertices_of(const SceneLayout::Drawable& drawable, const Deformations& deformed) {
    const Deformation* const found = find_deformation(deformed, drawable.item);
    return found == nullptr ? drawable.primitive().vertices
                            : (*found->vertices)[drawable.drawn->index_in_mesh];
}

const Box& bounds_of(const SceneLayout::Drawable& drawable, const Deformations& deformed) {
    const Deformation* const found = find_deformation(deformed, drawable.item);
    return found == nullptr ? drawable.drawn->bounds : found->bounds[drawable.drawn->index_in_mesh];
}

std::span<const Box> parts_of(const SceneLayout::Drawable& drawable, const Deformations& deformed) {
    const std::vector<Box>& parts = drawable.drawn->parts;
    if (!parts.empty() && find_deformation(deformed, drawable.item) == nullptr) return parts;
    return {&bounds_of(drawable, deformed), 1};
}

std::vector<std::uint32_t> moved_drawables(const SceneLayout& layout, const SharedArray<glm::mat4>& before,
                                           const SharedArray<glm::mat4>& now) {
    std::vector<std::uint32_t> moved;
    visit_differences(before, now, [&](std::size_t item) {
        layout.visit_drawables(item, [&](std::uint32_t i) { moved.push_back(i); });
    });
    std::ranges::sort(moved);
    return moved;
}

std::vector<std::uint32_t> moved_solids(const SceneLayout& layout, const ScenePlacement& before,
                                        const ScenePlacement& now) {
    std::vector<std::uint32_t> moved = moved_drawables(layout, before.world, now.world);
    const auto add = [&](std::uint32_t item) {
        layout.visit_drawables(item, [&](std::uint32_t i) { moved.push_back(i); });
    };
    for (const auto& [item, deformation] : now.deformed) {
        const Deformation* const last = find_deformation(before.deformed, item);
        if (last != nullptr && last->vertices == deformation.vertices) continue;
        add(item);
    }
    for (const auto& [item, deformation] : before.deformed) {
        if (item < now.world.size() && !now.deformed.contains(item)) add(item);
    }
    std::ranges::sort(moved);
    moved.erase(std::unique(moved.begin(), moved.end()), moved.end());
    std::erase_if(moved, [&](std::uint32_t i) { return !SceneLayout::is_solid(layout.drawables[i]); });
    return moved;
}

}  // namespace candela
