#include "renderer/passes/scene/bvh.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <memory>
#include <span>
#include <utility>
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
    std::uint32_t top_room = 0;  // nodes
    RangePlaces nodes;
    RangePlaces triangles;
};

struct HierarchyBuffers {
    BufferHandle<gpu::WideNode> nodes;
    BufferHandle<gpu::TraceTriangle> triangles;
};

using Objects = std::vector<std::unique_ptr<ObjectHierarchy>>;

std::vector<BufferRange*> ranges_of(const Objects& objects, std::span<const std::uint32_t> which,
                                    BufferRange ObjectHierarchy::*range) {
    std::vector<BufferRange*> ranges;
    ranges.reserve(which.size());
    for (const std::uint32_t i : which) ranges.push_back(&(*objects[i].*range));
    return ranges;
}

/// How many wide nodes the top has.
std::uint32_t top_size_of(const SceneHierarchy& scene) {
    return std::max(static_cast<std::uint32_t>(scene.top.top().bvh.nodes.size() / 2), 1U);
}

std::vector<std::uint32_t> all_objects(const SceneHierarchy& scene) {
    const Objects& objects = scene.objects;
    std::vector<std::uint32_t> all;
    for (std::uint32_t i = 0; i < objects.size(); ++i) {
        if (objects[i]) all.push_back(i);
    }
    return all;
}

/// Frees the places in the buffers of what is gone, and gives places to what has none. Returns whether any
/// that had one has got another.
bool place(Execution& run, const HierarchyBuffers& buffers, UploadedHierarchy& uploaded) {
    SceneHierarchy& scene = uploaded.scene;
    SceneHierarchy::Freed freed = scene.take_freed();
    for (BufferRange& range : freed.nodes) uploaded.nodes.take_back(range);
    for (BufferRange& range : freed.triangles) uploaded.triangles.take_back(range);

    const auto every = [&](BufferRange ObjectHierarchy::*range) {
        return ranges_of(scene.objects, all_objects(scene), range);
    };
    const bool moved_triangles =
        place_ranges(run, buffers.triangles, uploaded.triangles,
                     ranges_of(scene.objects, scene.changed(), &ObjectHierarchy::triangles),
                     [&] { return every(&ObjectHierarchy::triangles); });
    std::vector<BufferRange*> nodes = ranges_of(scene.objects, scene.changed(), &ObjectHierarchy::nodes);
    const std::uint32_t top_size = top_size_of(scene);
    const bool other_top = top_size > uploaded.top_room;
    if (other_top) {
        uploaded.top_room = top_size + top_size / 4;
        uploaded.nodes.clear(uploaded.top_room);
        nodes = every(&ObjectHierarchy::nodes);
        for (BufferRange* range : nodes) *range = {.count = range->count};
    }
    const bool moved_nodes = place_ranges(
        run, buffers.nodes, uploaded.nodes, nodes, [&] { return every(&ObjectHierarchy::nodes); },
        uploaded.top_room);
    if (moved_triangles) {  // nodes contain their places
        for (BufferRange* range : every(&ObjectHierarchy::nodes)) range->uploaded = false;
    }
    return other_top || moved_triangles || moved_nodes;
}

/// The triangles of a drawable, and once more with their second texture coordinates if rays need these.
void write_triangles(const SceneLayout& layout, const SceneLayout::Drawable& drawable,
                     std::span<const Vertex> vertices, const ObjectHierarchy& object, std::uint32_t first_id,
                     BufferWriter<gpu::TraceTriangle>& writer) {
    const auto count = static_cast<std::uint32_t>(object.bvh.order.size());
    const bool has_second = object.triangles.count > count;
    const auto traced = [&](std::uint32_t i) {
        return trace_triangle(layout, drawable, vertices, i, object.source.world, first_id + i);
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

/// `which`: those that may have changed.
void upload_objects(const Gpu& gpu, Execution& run, const HierarchyBuffers& buffers,
                    const SceneHierarchy& scene, std::span<const std::uint32_t> which,
                    const SceneLayout& layout, const Deformations& deformed) {
    upload_ranges(gpu, run, buffers.nodes, ranges_of(scene.objects, which, &ObjectHierarchy::nodes),
                  [&](std::size_t i, BufferWriter<gpu::WideNode>& writer) {
                      writer.append(wide_nodes(scene.placed()[which[i]]));
                  });
    upload_ranges(gpu, run, buffers.triangles, ranges_of(scene.objects, which, &ObjectHierarchy::triangles),
                  [&](std::size_t i, BufferWriter<gpu::TraceTriangle>& writer) {
                      const std::uint32_t object = which[i];
                      const SceneLayout::Drawable& drawable = layout.drawables[object];
                      const std::span<const Vertex> vertices = vertices_of(drawable, deformed);
                      write_triangles(layout, drawable, vertices, *scene.objects[object],
                                      scene.ids.first(scene.objects[object]->key()), writer);
                  });
}

/// `all`: not only the nodes that have changed.
void upload_top(const Gpu& gpu, Execution& run, const HierarchyBuffers& buffers, SceneHierarchy& scene,
                bool all) {
    const TopBvh& top = scene.top.top();
    const auto changed = scene.top.take_changed();
    if (all || !changed) {
        // Buffers must not be empty.
        if (top.leaves.empty()) upload_one(gpu, run, buffers.triangles, gpu::TraceTriangle{});
        upload<gpu::WideNode>(gpu, run, buffers.nodes, wide_nodes(top, scene.placed()));
        return;
    }
    BufferWriter<gpu::WideNode> writer(gpu, run.object(buffers.nodes));
    for (const std::uint32_t i : *changed) {
        writer.seek(i);
        writer.push_back(wide_node_at(top, scene.placed(), i));
    }
    writer.flush();
}

/// Uploads what has changed since the last call.
void upload_hierarchy(const Gpu& gpu, Execution& run, const HierarchyBuffers& buffers,
                      UploadedHierarchy& uploaded, const SceneLayout& layout, const Deformations& deformed) {
    SceneHierarchy& scene = uploaded.scene;
    const bool all = place(run, buffers, uploaded);
    const std::vector<std::uint32_t> which = all ? all_objects(scene) : scene.changed();
    for (const std::uint32_t i : which) scene.note_place(i);
    upload_objects(gpu, run, buffers, scene, which, layout, deformed);
    upload_top(gpu, run, buffers, scene, all);
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
            uploaded->scene.update(layout, placement);
            upload_hierarchy(gpu, run, buffers, *uploaded, layout, placement.deformed);
            const SceneMetrics now = uploaded->scene.metrics();
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
