#pragma once

#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>

#include "engine/bvh/bvh.hpp"
#include "engine/graph/frame_graph.hpp"
#include "renderer/gpu.hpp"
#include "renderer/gpu_types.hpp"
#include "renderer/passes/scene_upload.hpp"

namespace candela {

/// What the lighting needs to know of the scene as a whole, in world space: of the surfaces that stop light,
/// masked ones as if they had no holes.
struct SceneMetrics {
    glm::vec3 lower{0.0F};  ///< metres
    glm::vec3 upper{0.0F};
    float area = 0.0F;         ///< of all triangles, one side each, m²
    float mean_albedo = 0.0F;  ///< over the area, of each material's strongest channel
    std::uint64_t triangles = 0;
    bool operator==(const SceneMetrics&) const = default;

    [[nodiscard]] glm::vec3 centre() const { return (lower + upper) * 0.5F; }
    /// Of the sphere around the box; 0 for an empty scene.
    [[nodiscard]] float radius() const { return glm::length(upper - lower) * 0.5F; }
    /// How far above a surface rays start, in metres: some hundred times the rounding of positions.
    [[nodiscard]] float ray_offset() const { return 2e-5F * scale(); }
    /// The radius rounded down to a power of two, so that it stays while things move.
    [[nodiscard]] float scale() const {
        return radius() > 0.0F ? std::exp2(std::floor(std::log2(radius()))) : 0.0F;
    }
};

/// The hierarchy on the CPU, kept from frame to frame so that it can be refitted.
struct SceneHierarchy {
    Bvh bvh;
    std::vector<const Primitive*> built_for;  ///< primitive of each drawable when the topology was made
    float built_cost = 0.0F;                  ///< surface-area cost at that time
};

/// What rays are traced against.
struct Tracing {
    BufferHandle<gpu::BvhNode> nodes;
    BufferHandle<gpu::TraceTriangle> triangles;  ///< world space, in the order of the leaves
    BufferHandle<gpu::Material> materials;
    BufferHandle<std::uint32_t> texels;
    ValueHandle<SceneMetrics> metrics;
};

/// Node `bvh`: builds the hierarchy over the triangles that stop light, in world space; where instances only
/// moved, refits it, until its cost has grown by half.
[[nodiscard]] Tracing add_bvh(FrameGraph& graph, const Gpu& gpu, const SceneData& scene);

/// For a pass that traces: declares its reads, and binds them and sets its uniforms when it runs.
void read_tracing(Pass& pass, const Tracing& tracing);
void bind_tracing(const Gpu& gpu, Execution& run, const gl::Program& program, const Tracing& tracing);

}  // namespace candela
