#include "renderer/passes/scene/bvh.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

#include <candela/graph/execute.hpp>
#include "renderer/passes/scene/world_triangles.hpp"
#include "renderer/passes/upload.hpp"

namespace candela {
namespace {

constexpr float rebuild_above = 1.5F;  // times the SAH cost at the last build

std::vector<const Primitive*> primitives_of(const SceneLayout& layout) {
    std::vector<const Primitive*> primitives;
    for (const SceneLayout::Drawable& drawable : layout.solids()) {
        primitives.push_back(drawable.primitive);
    }
    return primitives;
}

SceneHierarchy build(const SceneLayout& layout, std::span<const Triangle> triangles) {
    SceneHierarchy hierarchy{build_bvh(triangles), primitives_of(layout), 0.0F};
    hierarchy.built_cost = sah_cost(hierarchy.bvh);
    return hierarchy;
}

SceneHierarchy update(const SceneHierarchy* previous, const SceneLayout& layout,
                      std::span<const Triangle> triangles) {
    const bool same_topology = previous != nullptr && previous->built_for == primitives_of(layout);
    if (!same_topology) {
        return build(layout, triangles);
    }
    SceneHierarchy refitted = *previous;
    refit(refitted.bvh, triangles);
    const bool degraded = sah_cost(refitted.bvh) > rebuild_above * refitted.built_cost;
    return degraded ? build(layout, triangles) : refitted;
}

SceneMetrics measure(const SceneLayout& layout, const WorldTriangles& world) {
    SceneMetrics metrics;
    metrics.triangles = world.triangles.size();
    if (world.triangles.empty()) {
        return metrics;
    }
    metrics.lower = metrics.upper = world.triangles.front().a;
    double area_sum = 0.0;
    double reflecting_sum = 0.0;
    for (std::size_t i = 0; i < world.triangles.size(); ++i) {
        const Triangle& t = world.triangles[i];
        metrics.lower = glm::min(metrics.lower, glm::min(t.a, glm::min(t.b, t.c)));
        metrics.upper = glm::max(metrics.upper, glm::max(t.a, glm::max(t.b, t.c)));
        const double area = 0.5 * static_cast<double>(glm::length(glm::cross(t.b - t.a, t.c - t.a)));
        area_sum += area;
        reflecting_sum += area * static_cast<double>(layout.drawables[world.origins[i].drawable].albedo);
    }
    metrics.area = static_cast<float>(area_sum);
    metrics.mean_albedo = area_sum > 0.0 ? static_cast<float>(reflecting_sum / area_sum) : 0.0F;
    return metrics;
}

/// An empty scene gets one leaf with a triangle without area, which no ray hits.
void upload_hierarchy(const Gpu& gpu, Execution& run, const Tracing& out, const Bvh& bvh,
                      const std::vector<gpu::TraceTriangle>& triangles) {
    if (bvh.nodes.empty()) {
        upload_one(gpu, run, out.nodes, gpu::BvhNode{.lower = {}, .first = 0, .upper = {}, .count = 1});
        upload_one(gpu, run, out.triangles, gpu::TraceTriangle{});
        return;
    }
    upload<gpu::BvhNode>(gpu, run, out.nodes, bvh.nodes);
    upload<gpu::TraceTriangle>(gpu, run, out.triangles, triangles);
}

}  // namespace

Tracing add_bvh(FrameGraph& graph, const Gpu& gpu, const SceneData& scene) {
    return graph.add("bvh", [&](Pass& pass) {
        pass.remembers();  // a tree refitted to moved triangles differs from a new one
        pass.read(scene.layout);
        pass.read(scene.placement);
        const auto hierarchy = pass.update(graph.value<SceneHierarchy>("hierarchy"));
        const Tracing out{
            .nodes =
                pass.write(graph.buffer<gpu::BvhNode>("bvh nodes", 1, Lifetime::persistent), Usage::copy),
            .triangles = pass.write(graph.buffer<gpu::TraceTriangle>("triangles", 1, Lifetime::persistent),
                                    Usage::copy),
            .materials = scene.materials,
            .texels = scene.texels,
            .metrics = pass.write(graph.value<SceneMetrics>("scene metrics"))};
        pass.run([=, &gpu, layout_handle = scene.layout, placement_handle = scene.placement](Execution& run) {
            const SceneLayout& layout = run.value(layout_handle);
            const WorldTriangles world = place_triangles(layout, run.value(placement_handle));
            SceneHierarchy updated = update(run.previous(hierarchy), layout, world.triangles);
            upload_hierarchy(gpu, run, out, updated.bvh, trace_triangles(layout, world, updated.bvh.order));
            run.set(out.metrics, measure(layout, world));
            run.set(hierarchy, std::move(updated));
        });
        return out;
    });
}

void read_tracing(Pass& pass, const Tracing& tracing) {
    pass.read(tracing.nodes, {Usage::storage, BINDING_BVH_NODES});
    pass.read(tracing.triangles, {Usage::storage, BINDING_TRIANGLES});
    pass.read(tracing.materials, {Usage::storage, BINDING_MATERIALS});
    pass.read(tracing.texels, {Usage::storage, BINDING_TEXELS});
    pass.read(tracing.metrics);
}

}  // namespace candela
