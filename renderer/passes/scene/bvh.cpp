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

/// The hierarchy, and where its parts lie in the buffers: the nodes of the top come first, then the
/// instances, by object, then the nodes of meshes.
struct UploadedHierarchy {
    SceneHierarchy scene;
    std::uint32_t room = 0;  // of the top, and of the instances: nodes
    RangePlaces nodes;
    RangePlaces triangles;
};

struct HierarchyBuffers {
    BufferHandle<gpu::WideNode> nodes;
    BufferHandle<gpu::TraceTriangle> triangles;
};

std::vector<BufferRange*> ranges_of(const std::vector<MeshHierarchy*>& meshes,
                                    BufferRange MeshHierarchy::*range) {
    std::vector<BufferRange*> ranges;
    ranges.reserve(meshes.size());
    for (MeshHierarchy* const mesh : meshes) ranges.push_back(&(mesh->*range));
    return ranges;
}

std::vector<std::uint32_t> all_objects(const SceneHierarchy& scene) {
    std::vector<std::uint32_t> all;
    for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
        if (scene.objects[i]) all.push_back(i);
    }
    return all;
}

/// Ensures that the first nodes have room for the top and the instances. Returns whether they had too little:
/// all other nodes then have no place.
bool make_room(UploadedHierarchy& uploaded) {
    // Of n objects, the top has n - 1 wide nodes, but at least one.
    const auto objects = static_cast<std::uint32_t>(uploaded.scene.objects.size());
    if (uploaded.room > 0 && objects <= uploaded.room) return false;
    uploaded.room = objects + objects / 4 + 64;
    uploaded.nodes.clear(2 * uploaded.room);
    for (MeshHierarchy* const mesh : uploaded.scene.meshes_of(all_objects(uploaded.scene))) {
        mesh->nodes = {.count = mesh->nodes.count};
    }
    return true;
}

/// Frees the places in the buffers of what is gone, and gives places to what has none. Returns whether any
/// that had one has got another.
bool place(Execution& run, const HierarchyBuffers& buffers, UploadedHierarchy& uploaded) {
    SceneHierarchy& scene = uploaded.scene;
    SceneHierarchy::Freed freed = scene.take_freed();
    for (BufferRange& range : freed.nodes) uploaded.nodes.take_back(range);
    for (BufferRange& range : freed.triangles) uploaded.triangles.take_back(range);

    const auto all = [&](BufferRange MeshHierarchy::*range) {
        return ranges_of(scene.meshes_of(all_objects(scene)), range);
    };
    const bool no_room = make_room(uploaded);
    const auto which = no_room ? all_objects(scene) : scene.changed();
    const std::vector<MeshHierarchy*> meshes = scene.meshes_of(which);
    const bool moved_triangles =
        place_ranges(run, buffers.triangles, uploaded.triangles, ranges_of(meshes, &MeshHierarchy::triangles),
                     [&] { return all(&MeshHierarchy::triangles); });
    const bool moved_nodes = place_ranges(
        run, buffers.nodes, uploaded.nodes, ranges_of(meshes, &MeshHierarchy::nodes),
        [&] { return all(&MeshHierarchy::nodes); }, 2 * uploaded.room);
    if (moved_triangles) {  // nodes contain their places
        for (BufferRange* const range : all(&MeshHierarchy::nodes)) range->uploaded = false;
    }
    return no_room || moved_triangles || moved_nodes;
}

/// The triangles of a mesh, and once more with their second texture coordinates if rays need these.
void write_triangles(const MeshHierarchy& mesh, BufferWriter<gpu::TraceTriangle>& writer) {
    const PlacedMesh placed = mesh.placed();
    const bool has_second = mesh.triangles.count > placed.count();
    const std::uint32_t first_id = mesh.drawn->first_triangle;
    for (const std::uint32_t i : mesh.bvh.order) {
        gpu::TraceTriangle triangle = placed.traced(i, first_id + i);
        triangle.second = has_second ? placed.count() : 0;
        writer.push_back(triangle);
    }
    if (!has_second) return;
    for (const std::uint32_t i : mesh.bvh.order) {
        const std::array<glm::vec2, 3> uvs = placed.second_uvs(i);
        gpu::TraceTriangle triangle = placed.traced(i, first_id + i);
        triangle.uv_a = uvs[0];
        triangle.uv_b = uvs[1];
        triangle.uv_c = uvs[2];
        writer.push_back(triangle);
    }
}

void upload_meshes(const Gpu& gpu, Execution& run, const HierarchyBuffers& buffers,
                   const std::vector<MeshHierarchy*>& meshes) {
    upload_ranges(gpu, run, buffers.nodes, ranges_of(meshes, &MeshHierarchy::nodes),
                  [&](std::size_t i, BufferWriter<gpu::WideNode>& writer) {
                      writer.append(wide_nodes(meshes[i]->bvh, meshes[i]->place()));
                  });
    upload_ranges(gpu, run, buffers.triangles, ranges_of(meshes, &MeshHierarchy::triangles),
                  [&](std::size_t i, BufferWriter<gpu::TraceTriangle>& writer) {
                      write_triangles(*meshes[i], writer);
                  });
}

void upload_instances(const Gpu& gpu, Execution& run, const HierarchyBuffers& buffers,
                      const UploadedHierarchy& uploaded, std::span<const std::uint32_t> which) {
    BufferWriter<gpu::WideNode> writer(gpu, run.object(buffers.nodes));
    for (const std::uint32_t i : which) {
        const SceneObject& object = *uploaded.scene.objects[i];
        if (object.mesh->bvh.nodes.empty()) continue;
        const std::uint32_t root = root_word(object.mesh->bvh, object.mesh->place());
        writer.seek(uploaded.room + i);
        writer.push_back(instance_node(object.mesh_from_world, root, object.entity.index));
    }
    writer.flush();
}

/// `all`: not only the nodes that have changed.
void upload_top(const Gpu& gpu, Execution& run, const HierarchyBuffers& buffers, UploadedHierarchy& uploaded,
                bool all) {
    const Bvh& top = uploaded.scene.top.tree();
    const auto changed = uploaded.scene.top.take_changed();
    if (all || !changed) {
        // Buffers must not be empty.
        if (top.nodes.empty()) upload_one(gpu, run, buffers.triangles, gpu::TraceTriangle{});
        upload<gpu::WideNode>(gpu, run, buffers.nodes, top_nodes(top, uploaded.room));
        return;
    }
    BufferWriter<gpu::WideNode> writer(gpu, run.object(buffers.nodes));
    for (const std::uint32_t i : *changed) {
        writer.seek(i);
        writer.push_back(top_node(top, uploaded.room, i));
    }
    writer.flush();
}

/// Uploads what has changed since the last call.
void upload_hierarchy(const Gpu& gpu, Execution& run, const HierarchyBuffers& buffers,
                      UploadedHierarchy& uploaded) {
    const bool all = place(run, buffers, uploaded);
    const std::vector<std::uint32_t> which = all ? all_objects(uploaded.scene) : uploaded.scene.changed();
    upload_meshes(gpu, run, buffers, uploaded.scene.meshes_of(which));
    upload_instances(gpu, run, buffers, uploaded, which);
    upload_top(gpu, run, buffers, uploaded, all);
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
            const std::shared_ptr<UploadedHierarchy> uploaded =
                run.has_result() ? *run.previous(kept) : std::make_shared<UploadedHierarchy>();
            uploaded->scene.update(run.value(layout_handle), run.value(placement_handle));
            upload_hierarchy(gpu, run, buffers, *uploaded);
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
    pass.read(tracing.nodes, {Usage::sampled, UNIT_BVH_NODES});
    pass.read(tracing.triangles, {Usage::sampled, UNIT_TRIANGLES});
    pass.read(tracing.materials, {Usage::storage, BINDING_MATERIALS});
    pass.read(tracing.texels, {Usage::storage, BINDING_TEXELS});
    pass.read(tracing.metrics);
}

}  // namespace candela
