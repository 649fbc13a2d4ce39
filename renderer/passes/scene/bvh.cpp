#include "renderer/passes/scene/bvh.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <memory>
#include <span>
#include <vector>

#include <candela/graph/execute.hpp>
#include "renderer/gpu/buffer_ranges.hpp"
#include "renderer/gpu/growing_buffer.hpp"
#include "renderer/passes/scene/world_triangles.hpp"

namespace candela {
namespace {

/// The hierarchy, and where its parts lie in the buffers: the nodes of the top come first.
struct UploadedHierarchy {
    SceneHierarchy scene;
    std::uint32_t top_room = 0;   // nodes
    std::uint32_t nodes_end = 0;  // see place_ranges
    std::uint32_t triangles_end = 0;
};

struct HierarchyBuffers {
    BufferHandle<gpu::WideNode> nodes;
    BufferHandle<gpu::TraceTriangle> triangles;
};

std::vector<BufferRange*> ranges_of(std::vector<ObjectHierarchy>& objects,
                                    BufferRange ObjectHierarchy::*range) {
    std::vector<BufferRange*> ranges;
    ranges.reserve(objects.size());
    for (ObjectHierarchy& object : objects) {
        ranges.push_back(&(object.*range));
    }
    return ranges;
}

/// Assigns places in the buffers to what has none.
void place(Execution& run, const HierarchyBuffers& buffers, UploadedHierarchy& uploaded) {
    std::vector<ObjectHierarchy>& objects = uploaded.scene.objects;
    const auto top_size = std::max(static_cast<std::uint32_t>(uploaded.scene.top.bvh.nodes.size() / 2), 1U);
    if (top_size > uploaded.top_room) {
        uploaded.top_room = uploaded.nodes_end = top_size + top_size / 4;
        for (ObjectHierarchy& object : objects) {
            object.nodes = {.count = object.nodes.count};
        }
    }
    const bool all_moved = place_ranges(
        run, buffers.triangles, ranges_of(objects, &ObjectHierarchy::triangles), uploaded.triangles_end);
    for (ObjectHierarchy& object : objects) {
        object.nodes.uploaded &= !all_moved;  // they contain the places of triangles
    }
    place_ranges(run, buffers.nodes, ranges_of(objects, &ObjectHierarchy::nodes), uploaded.nodes_end,
                 uploaded.top_room);
}

/// The triangles of a drawable, and once more with their second texture coordinates if rays need these.
void write_triangles(const SceneLayout& layout, const SceneLayout::Drawable& drawable,
                     std::span<const Vertex> vertices, const ObjectHierarchy& object,
                     BufferWriter<gpu::TraceTriangle>& writer) {
    const auto count = static_cast<std::uint32_t>(object.bvh.order.size());
    const bool has_second = object.triangles.count > count;
    const auto traced = [&](std::uint32_t i) {
        return trace_triangle(layout, drawable, vertices, i, object.source.world, object.first_id + i);
    };
    for (const std::uint32_t i : object.bvh.order) {
        gpu::TraceTriangle triangle = traced(i);
        triangle.second = has_second ? count : 0;
        writer.push_back(triangle);
    }
    if (!has_second) return;
    for (const std::uint32_t i : object.bvh.order) {
        const std::array<glm::vec2, 3> uvs = trace_second_uvs(layout, drawable, i);
        gpu::TraceTriangle triangle = traced(i);
        triangle.uv_a = uvs[0];
        triangle.uv_b = uvs[1];
        triangle.uv_c = uvs[2];
        writer.push_back(triangle);
    }
}

void upload_objects(const Gpu& gpu, Execution& run, const HierarchyBuffers& buffers,
                    UploadedHierarchy& uploaded, const SceneLayout& layout, const Deformations& deformed) {
    std::vector<ObjectHierarchy>& objects = uploaded.scene.objects;
    const std::vector<PlacedBvh> placed_bvhs = uploaded.scene.placed_objects();
    upload_ranges(gpu, run, buffers.nodes, ranges_of(objects, &ObjectHierarchy::nodes),
                  [&](std::size_t i, BufferWriter<gpu::WideNode>& writer) {
                      writer.append(wide_nodes(placed_bvhs[i]));
                  });
    upload_ranges(gpu, run, buffers.triangles, ranges_of(objects, &ObjectHierarchy::triangles),
                  [&](std::size_t i, BufferWriter<gpu::TraceTriangle>& writer) {
                      const ObjectHierarchy& object = objects[i];
                      const SceneLayout::Drawable& drawable = layout.drawables[i];
                      const std::span<const Vertex> vertices = vertices_of(drawable, deformed);
                      write_triangles(layout, drawable, vertices, object, writer);
                  });
}

void upload_top(const Gpu& gpu, Execution& run, const HierarchyBuffers& buffers,
                const SceneHierarchy& scene) {
    // Buffers must not be empty.
    if (scene.top.leaves.empty()) upload_one(gpu, run, buffers.triangles, gpu::TraceTriangle{});
    upload<gpu::WideNode>(gpu, run, buffers.nodes, wide_nodes(scene.top, scene.placed_objects()));
}

void warn_of_rounding(Log& log, const SceneMetrics& metrics) {
    constexpr float most = 1e-3F;  // metres: thinner walls are rare
    const float step = metrics.coordinate_step();
    if (metrics.is_far() && step > most) {
        log.warn(
            fmt::format("the scene is so far from the origin that positions are rounded to {:.1f} mm: "
                        "light may leak where surfaces meet and through thin walls",
                        1e3F * step));
    }
}

}  // namespace

Tracing add_bvh(FrameGraph& graph, Gpu& gpu, const SceneData& scene) {
    return graph.add("bvh", [&](Pass& pass) {
        pass.keeps_state();  // a tree refitted to moved triangles differs from a new one
        pass.read(scene.layout);
        pass.read(scene.placement);
        // Shared, because the hierarchy is changed in place.
        const auto kept = pass.update(graph.value<std::shared_ptr<UploadedHierarchy>>("hierarchy"));
        const HierarchyBuffers buffers{
            pass.update(growing_buffer<gpu::WideNode>(graph, "bvh nodes"), Usage::copy),
            pass.update(growing_buffer<gpu::TraceTriangle>(graph, "triangles"), Usage::copy)};
        const auto metrics = pass.write(graph.value<SceneMetrics>("scene metrics"));
        const auto hierarchy =
            pass.write(graph.value<std::shared_ptr<const SceneHierarchy>>("traced hierarchy"));
        pass.run([=, &gpu, layout_handle = scene.layout, placement_handle = scene.placement](Execution& run) {
            const SceneLayout& layout = run.value(layout_handle);
            const std::shared_ptr<UploadedHierarchy> uploaded =
                run.has_result() ? *run.previous(kept) : std::make_shared<UploadedHierarchy>();
            const ScenePlacement& placement = run.value(placement_handle);
            uploaded->scene.update(layout, placement, run.changed(layout_handle));
            place(run, buffers, *uploaded);
            upload_objects(gpu, run, buffers, *uploaded, layout, placement.deformed);
            upload_top(gpu, run, buffers, uploaded->scene);
            const SceneMetrics now = uploaded->scene.metrics(layout);
            warn_of_rounding(gpu.log(), now);
            run.set(metrics, now);
            run.set(kept, uploaded);
            run.set(hierarchy, std::shared_ptr<const SceneHierarchy>(uploaded, &uploaded->scene));
        });
        return Tracing{.nodes = buffers.nodes,
                       .triangles = buffers.triangles,
                       .materials = scene.materials,
                       .texels = scene.texels,
                       .metrics = metrics,
                       .hierarchy = hierarchy};
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
