#pragma once

#include <cstdint>
#include <memory>

#include <candela/graph/frame_graph.hpp>
#include "engine/bvh/bvh.hpp"
#include "renderer/gpu/gpu.hpp"
#include "renderer/gpu/gpu_types.hpp"
#include "renderer/passes/scene/scene_hierarchy.hpp"
#include "renderer/passes/scene/scene_upload.hpp"

namespace candela {

/// What shaders trace rays against: shaders/scene/bvh.glsl.
struct Tracing {
    BufferHandle<gpu::WideNode> nodes;
    BufferHandle<gpu::TraceTriangle> triangles;  ///< by mesh, in its space, in the order of the leaves
    BufferHandle<gpu::Material> materials;
    BufferHandle<std::uint32_t> texels;
    ValueHandle<SceneMetrics> metrics;
    /// On the CPU. Changed in place: who reads it must read the scene's layout and placement, too.
    ValueHandle<std::shared_ptr<const SceneHierarchy>> hierarchy;
};

/// Adds node `bvh` (CPU, then upload): a bounding-volume hierarchy over instances of the meshes that stop
/// light, and the scene's metrics: see SceneHierarchy. Only what has changed is uploaded. Depends on the
/// scene's layout and placement, and on its own last result.
[[nodiscard]] Tracing add_bvh(FrameGraph& graph, Gpu& gpu, const SceneData& scene);

/// For a pass whose shader includes bvh.glsl.
void read_tracing(Pass& pass, const Tracing& tracing);

}  // namespace candela
