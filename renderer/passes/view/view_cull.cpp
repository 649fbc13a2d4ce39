#include "renderer/passes/view/view_cull.hpp"

#include <algorithm>
#include <array>

#include <candela/graph/execute.hpp>
#include "renderer/gpu/growing_buffer.hpp"

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

bool is_outside(const Box& box, const glm::mat4& clip_from_box) {
    std::array<bool, 6> all_beyond;
    all_beyond.fill(true);
    for (unsigned i = 0; i < 8; ++i) {
        const glm::vec4 clip = clip_from_box * glm::vec4(box.corner(i), 1.0F);
        const float slack = rounding * (std::abs(clip.x) + std::abs(clip.y) + std::abs(clip.w));
        const std::array<float, 6> distances = plane_distances(clip);
        for (std::size_t plane = 0; plane < distances.size(); ++plane) {
            all_beyond[plane] = all_beyond[plane] && distances[plane] < -slack;
        }
    }
    return std::ranges::find(all_beyond, true) != all_beyond.end();
}

std::vector<gpu::DrawCommand> visible_draws(const SceneLayout& layout, const ScenePlacement& placement,
                                            const CameraView& view) {
    std::vector<gpu::DrawCommand> draws = layout.draws;
    for (std::size_t i = 0; i < draws.size(); ++i) {
        const SceneLayout::Drawable& drawable = layout.drawables[i];
        if (is_outside(bounds_of(drawable, placement.deformed),
                       view.clip_from_world * placement.world[drawable.item])) {
            draws[i].instance_count = 0;
        }
    }
    return draws;
}

SceneData add_view_cull(FrameGraph& graph, const Gpu& gpu, const SceneData& scene,
                        ValueHandle<CameraView> camera) {
    return graph.add("view-cull", [&](Pass& pass) {
        pass.read(scene.layout);
        pass.read(scene.placement);
        pass.read(camera);
        SceneData out = scene;
        out.draws = pass.write(growing_buffer<gpu::DrawCommand>(graph, "visible draws"), Usage::copy);
        pass.run([=, &gpu](Execution& run) {
            upload<gpu::DrawCommand>(
                gpu, run, out.draws,
                visible_draws(run.value(out.layout), run.value(out.placement), run.value(camera)));
        });
        return out;
    });
}

}  // namespace candela
