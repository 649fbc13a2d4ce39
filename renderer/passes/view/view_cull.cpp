#include "renderer/passes/view/view_cull.hpp"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include <candela/graph/execute.hpp>
#include "renderer/gpu/buffer_ranges.hpp"
#include "renderer/gpu/growing_buffer.hpp"
#include "renderer/passes/view/seen_objects.hpp"

namespace candela {
namespace {

/// Changed in place, so that it cannot be compared.
struct KeptView {
    std::shared_ptr<SeenObjects> seen;
    SharedArray<gpu::DrawCommand> draws;  // those that were culled
};

/// What a view is culled from, and where the draws go.
struct CullNode {
    SceneData scene;
    ValueHandle<std::shared_ptr<const SceneHierarchy>> hierarchy;
    ValueHandle<CameraView> camera;
    ValueHandle<KeptView> kept;
    BufferHandle<gpu::DrawCommand> draws;
};

/// The indices of the draw commands that may differ from those in the buffer, ascending.
std::vector<std::uint32_t> changed_draws(const SceneLayout& layout, const std::vector<std::uint32_t>& objects,
                                         const SharedArray<gpu::DrawCommand>& before) {
    std::vector<std::uint32_t> changed;
    for (const std::uint32_t object : objects) {
        if (SceneLayout::is_solid(layout.drawables[object])) changed.push_back(layout.draw_of[object]);
    }
    visit_changes(before, layout.draws,
                  [&](std::size_t i) { changed.push_back(static_cast<std::uint32_t>(i)); });
    layout.visit_blended([&](const SceneLayout::Group&, std::uint32_t draw) { changed.push_back(draw); });
    std::ranges::sort(changed);
    changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
    return changed;
}

void cull(const Gpu& gpu, Execution& run, const CullNode& node) {
    const SceneLayout& layout = run.value(node.scene.layout);
    const ScenePlacement& placement = run.value(node.scene.placement);
    const glm::mat4& clip_from_world = run.value(node.camera).clip_from_world;
    // Another hierarchy was made anew, and its revision may have the same number.
    const bool other_top = !run.has_result() || run.changed(node.hierarchy);
    KeptView kept = other_top ? KeptView{std::make_shared<SeenObjects>(), {}} : *run.previous(node.kept);
    const std::vector<std::uint32_t> objects =
        kept.seen->update(run.value(node.hierarchy)->top, layout.drawables.size(), clip_from_world);
    if (reserve_more(run, node.draws, layout.draws.size())) kept.draws = {};
    const auto is_seen = [&](std::uint32_t number) {
        const SceneLayout::Drawable& drawable = layout.drawables[number];
        if (drawable.drawn->is_solid) return kept.seen->sees(number);
        const Box& bounds = bounds_of(drawable, placement.deformed);
        return in_view(bounds, clip_from_world * placement.world[drawable.item]) != InView::outside;
    };
    BufferWriter<gpu::DrawCommand> writer(gpu, run.object(node.draws));
    for (const std::uint32_t i : changed_draws(layout, objects, kept.draws)) {
        gpu::DrawCommand draw = layout.draws[i];
        if (draw.instance_count > 0) draw.instance_count = is_seen(draw.base_instance) ? 1 : 0;
        writer.seek(i);
        writer.push_back(draw);
    }
    writer.flush();
    kept.draws = layout.draws;
    run.set(node.kept, kept);
}

}  // namespace

SceneData add_view_cull(FrameGraph& graph, const Gpu& gpu, const SceneData& scene, const Tracing& tracing,
                        ValueHandle<CameraView> camera) {
    return graph.add("view-cull", [&](Pass& pass) {
        pass.read(scene.layout);
        pass.read(scene.placement);
        pass.read(tracing.hierarchy);
        pass.read(camera);
        const CullNode node{
            .scene = scene,
            .hierarchy = tracing.hierarchy,
            .camera = camera,
            .kept = pass.update(graph.value<KeptView>("seen objects")),
            .draws = pass.update(growing_buffer<gpu::DrawCommand>(graph, "visible draws"), Usage::copy)};
        pass.run([=, &gpu](Execution& run) { cull(gpu, run, node); });
        SceneData out = scene;
        out.draws = node.draws;
        return out;
    });
}

}  // namespace candela
