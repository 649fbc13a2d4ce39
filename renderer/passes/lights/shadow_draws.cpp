#include "renderer/passes/lights/shadow_draws.hpp"

#include <algorithm>
#include <cstddef>

#include "renderer/passes/scene/world_triangles.hpp"
#include "renderer/passes/view/seen_objects.hpp"

namespace candela {
namespace {

/// To a clip space that contains all that may mark a texel: up to two texels beside the map, and at any depth
/// in front of the light.
glm::mat4 clip_of_marked(const glm::mat4& clip_from_world, std::uint32_t resolution) {
    const float narrower = 1.0F / (1.0F + 4.0F / static_cast<float>(resolution));
    glm::mat4 clip = clip_from_world;
    for (glm::length_t column = 0; column < 4; ++column) {
        clip[column].x *= narrower;
        clip[column].y *= narrower;
        clip[column].z = 0.5F * clip[column].w;
    }
    return clip;
}

bool follows(const gpu::DrawCommand& draw, const gpu::DrawCommand& before) {
    return draw.base_instance == before.base_instance &&
           draw.first_index == before.first_index + before.index_count;
}

}  // namespace

std::vector<ShadowCaster> shadow_casters(const SceneLayout& layout, const ScenePlacement& placement,
                                         float margin) {
    std::vector<ShadowCaster> casters;
    layout.visit_solids([&](std::uint32_t i) {
        const SceneLayout::Drawable& drawable = layout.drawables[i];
        const gpu::DrawCommand& whole = layout.draws[layout.draw_of[i]];
        const std::span<const Box> parts = parts_of(drawable, placement.deformed);
        const auto part_size = parts.size() > 1 ? 3 * triangles_per_part : whole.index_count;
        for (std::uint32_t part = 0; part < parts.size(); ++part) {
            ShadowCaster caster{whole, place_box(parts[part], placement.world[drawable.item])};
            caster.bounds.lower -= margin;
            caster.bounds.upper += margin;
            caster.draw.first_index += part * part_size;
            caster.draw.index_count = std::min(part_size, whole.index_count - part * part_size);
            casters.push_back(caster);
        }
    });
    return casters;
}

void append_shadow_draws(std::span<const ShadowCaster> casters, const glm::mat4& clip_from_world,
                         std::uint32_t resolution, std::vector<gpu::DrawCommand>& draws) {
    const glm::mat4 clip = clip_of_marked(clip_from_world, resolution);
    const std::size_t begin = draws.size();
    for (const ShadowCaster& caster : casters) {
        if (in_view(caster.bounds, clip) == InView::outside) continue;
        if (draws.size() > begin && follows(caster.draw, draws.back())) {
            draws.back().index_count += caster.draw.index_count;
        } else {
            draws.push_back(caster.draw);
        }
    }
}

}  // namespace candela
