#include "renderer/passes/bvh.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

#include "engine/graph/execute.hpp"
#include "renderer/passes/material_upload.hpp"
#include "renderer/passes/upload.hpp"

namespace candela {
namespace {

constexpr float rebuild_above = 1.5F;  // times the cost at which the topology was made

/// A triangle's place in the scene.
struct Origin {
    std::uint32_t drawable;
    std::uint32_t first_index;  // of three, in the primitive
};

struct WorldTriangles {
    std::vector<Triangle> triangles;
    std::vector<Origin> origins;
};

glm::vec3 transformed(const glm::mat4& matrix, glm::vec3 point) {
    return glm::vec3(matrix * glm::vec4(point, 1.0F));
}

/// The indices of a triangle's corners, counter-clockwise in the world.
glm::uvec3 corners(const SceneLayout& layout, const Origin& origin) {
    const SceneLayout::Drawable& drawable = layout.drawables[origin.drawable];
    const auto& indices = drawable.primitive->indices;
    const std::uint32_t i = origin.first_index;
    if (layout.geometry.items[drawable.item].mirrored) {
        return {indices[i], indices[i + 2], indices[i + 1]};
    }
    return {indices[i], indices[i + 1], indices[i + 2]};
}

WorldTriangles place_triangles(const SceneLayout& layout, const ScenePlacement& placement) {
    WorldTriangles world;
    for (std::uint32_t d = 0; d < layout.solid_count; ++d) {
        const Primitive& primitive = *layout.drawables[d].primitive;
        const glm::mat4& matrix = placement.world[layout.drawables[d].item];
        for (std::uint32_t i = 0; i < primitive.indices.size(); i += 3) {
            const Origin origin{d, i};
            const glm::uvec3 corner = corners(layout, origin);
            world.triangles.push_back({transformed(matrix, primitive.vertices[corner.x].position),
                                       transformed(matrix, primitive.vertices[corner.y].position),
                                       transformed(matrix, primitive.vertices[corner.z].position)});
            world.origins.push_back(origin);
        }
    }
    return world;
}

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

std::vector<gpu::TraceTriangle> trace_triangles(const SceneLayout& layout, const WorldTriangles& world,
                                                std::span<const std::uint32_t> order) {
    std::vector<gpu::TraceTriangle> triangles;
    triangles.reserve(order.size());
    for (const std::uint32_t id : order) {
        const Triangle& triangle = world.triangles[id];
        const Origin& origin = world.origins[id];
        const SceneLayout::Drawable& drawable = layout.drawables[origin.drawable];
        const auto& vertices = drawable.primitive->vertices;
        const glm::uvec3 corner = corners(layout, origin);
        triangles.push_back({.a = triangle.a,
                             .material = drawable.material,
                             .edge_ab = triangle.b - triangle.a,
                             .id = id,
                             .edge_ac = triangle.c - triangle.a,
                             .masked = origin.drawable < layout.opaque_count ? 0U : 1U,
                             .uv_a = vertices[corner.x].uv,
                             .uv_b = vertices[corner.y].uv,
                             .uv_c = vertices[corner.z].uv});
    }
    return triangles;
}

SceneMetrics measure(const SceneLayout& layout, const WorldTriangles& world) {
    SceneMetrics metrics;
    metrics.triangles = world.triangles.size();
    if (world.triangles.empty()) {
        return metrics;
    }
    std::vector<float> albedo;
    for (const auto& material : layout.materials) {
        const glm::vec3 mean = mean_albedo(*material);
        albedo.push_back(std::max({mean.r, mean.g, mean.b}));
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
        reflecting_sum +=
            area * static_cast<double>(albedo[layout.drawables[world.origins[i].drawable].material]);
    }
    metrics.area = static_cast<float>(area_sum);
    metrics.mean_albedo = area_sum > 0.0 ? static_cast<float>(reflecting_sum / area_sum) : 0.0F;
    return metrics;
}

}  // namespace

Tracing add_bvh(FrameGraph& graph, const Gpu& gpu, const SceneData& scene) {
    return graph.add("bvh", [&](Pass& pass) {
        pass.read(scene.layout);
        pass.read(scene.placement);
        const auto hierarchy = pass.write(graph.value<SceneHierarchy>("hierarchy"));
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
            SceneHierarchy updated = update(run.find(hierarchy), layout, world.triangles);
            upload<gpu::BvhNode>(gpu, run, out.nodes, updated.bvh.nodes);
            upload<gpu::TraceTriangle>(gpu, run, out.triangles,
                                       trace_triangles(layout, world, updated.bvh.order));
            run.set(out.metrics, measure(layout, world));
            run.set(hierarchy, std::move(updated));
        });
        return out;
    });
}

void read_tracing(Pass& pass, const Tracing& tracing) {
    pass.read(tracing.nodes, Usage::storage);
    pass.read(tracing.triangles, Usage::storage);
    pass.read(tracing.materials, Usage::storage);
    pass.read(tracing.texels, Usage::storage);
    pass.read(tracing.metrics);
}

void bind_tracing(const Gpu& gpu, Execution& run, const gl::Program& program, const Tracing& tracing) {
    gpu.bind_storage(BINDING_BVH_NODES, run.object(tracing.nodes));
    gpu.bind_storage(BINDING_TRIANGLES, run.object(tracing.triangles));
    gpu.bind_storage(BINDING_MATERIALS, run.object(tracing.materials));
    gpu.bind_storage(BINDING_TEXELS, run.object(tracing.texels));
    program.set("triangle_count", static_cast<std::uint32_t>(run.value(tracing.metrics).triangles));
}

}  // namespace candela
