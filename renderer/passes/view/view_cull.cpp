#include "renderer/passes/view/view_cull.hpp"

#include <cstdint>
#include <memory>
#include <numeric>
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
};

/// What a view is culled from, and where the draws go.
struct CullNode {
    SceneData scene;
    ValueHandle<std::shared_ptr<const SceneHierarchy>> hierarchy;
    ValueHandle<CameraView> camera;
    ValueHandle<KeptView> kept;
    BufferHandle<gpu::DrawCommand> draws;
};

/// The draw of a drawable, for which nothing is drawn if it is not seen.
gpu::DrawCommand seen_draw(const SceneLayout& layout, std::uint32_t drawable, bool is_seen) {
    gpu::DrawCommand draw = layout.draws[drawable];
    draw.instance_count = is_seen ? 1 : 0;
    return draw;
}

void cull(const Gpu& gpu, Execution& run, const CullNode& node) {
    const SceneLayout& layout = run.value(node.scene.layout);
    const ScenePlacement& placement = run.value(node.scene.placement);
    const glm::mat4& clip_from_world = run.value(node.camera).clip_from_world;
    const std::shared_ptr<SeenObjects> seen =
        run.has_result() ? run.previous(node.kept)->seen : std::make_shared<SeenObjects>();
    // Another hierarchy was made anew, and its topology may have the same number.
    const bool all = !run.has_result() || run.changed(node.scene.layout) || run.changed(node.hierarchy);
    std::vector<std::uint32_t> changed =
        seen->update(run.value(node.hierarchy)->top, layout.solid_count, clip_from_world, all);
    run.set(node.kept, {seen});
    if (all) {
        changed.resize(layout.solid_count);
        std::iota(changed.begin(), changed.end(), 0U);
        run.reserve(node.draws, layout.draws.size());
    }
    BufferWriter<gpu::DrawCommand> writer(gpu, run.object(node.draws));
    for (const std::uint32_t i : changed) {
        writer.seek(i);
        writer.push_back(seen_draw(layout, i, seen->sees(i)));
    }
    writer.seek(layout.solid_count);
    for (std::uint32_t i = layout.solid_count; i < layout.drawables.size(); ++i) {
        const SceneLayout::Drawable& drawable = layout.drawables[i];
        const Box& bounds = bounds_of(drawable, placement.deformed);
        const InView where = in_view(bounds, clip_from_world * placement.world[drawable.item]);
        writer.push_back(seen_draw(layout, i, where != InView::outside));
    }
    writer.flush();
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
