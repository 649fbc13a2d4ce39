#pragma once

#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>

#include <candela/graph/frame_graph.hpp>
#include "engine/bvh/bvh.hpp"
#include "renderer/gpu.hpp"
#include "renderer/gpu_types.hpp"
#include "renderer/passes/scene/scene_upload.hpp"

namespace candela {

/// Properties of the whole scene that lighting uses, in world space. They cover the surfaces that stop light,
/// opaque and masked; holes in masks count as surface.
struct SceneMetrics {
    glm::vec3 lower{0.0F};  ///< corner of the bounding box, metres
    glm::vec3 upper{0.0F};
    float area = 0.0F;         ///< of all triangles, one side each, m²
    float mean_albedo = 0.0F;  ///< area-weighted mean of the strongest channel of each material's mean albedo
    std::uint64_t triangles = 0;
    bool operator==(const SceneMetrics&) const = default;

    [[nodiscard]] glm::vec3 centre() const { return (lower + upper) * 0.5F; }
    /// Radius of the bounding sphere of the box in metres; 0 for an empty scene.
    [[nodiscard]] float radius() const { return glm::length(upper - lower) * 0.5F; }
    /// Offset along the normal at which rays start, in metres: some hundred times the rounding error of
    /// positions.
    [[nodiscard]] float ray_offset() const { return 2e-5F * scale(); }
    /// The radius rounded down to a power of two, so that it rarely changes while objects move.
    [[nodiscard]] float scale() const {
        return radius() > 0.0F ? std::exp2(std::floor(std::log2(radius()))) : 0.0F;
    }
};

/// The BVH on the CPU, kept from frame to frame so that it can be refitted.
struct SceneHierarchy {
    Bvh bvh;
    std::vector<const Primitive*> built_for;  ///< primitive of each solid drawable at the last build
    float built_cost = 0.0F;                  ///< SAH cost at the last build
};

/// What shaders trace rays against: shaders/scene/bvh.glsl.
struct Tracing {
    BufferHandle<gpu::BvhNode> nodes;
    BufferHandle<gpu::TraceTriangle> triangles;  ///< world space, in the order of the leaves
    BufferHandle<gpu::Material> materials;
    BufferHandle<std::uint32_t> texels;
    ValueHandle<SceneMetrics> metrics;
};

/// Adds node `bvh` (CPU, then upload): a bounding-volume hierarchy over the triangles that stop light, in
/// world space, and the scene's metrics. Builds with a binned surface-area heuristic (Wald, 2007:
/// engine/bvh). If instances only moved, the hierarchy is refitted, and rebuilt once its SAH cost exceeds 1.5
/// times that of the last build. Depends on the scene's layout and placement.
[[nodiscard]] Tracing add_bvh(FrameGraph& graph, const Gpu& gpu, const SceneData& scene);

/// For a pass whose shader includes bvh.glsl.
void read_tracing(Pass& pass, const Tracing& tracing);

}  // namespace candela
