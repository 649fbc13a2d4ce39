#pragma once

#include <optional>

#include <candela/graph/frame_graph.hpp>
#include "renderer/gpu/gpu.hpp"
#include "renderer/passes/scene/bvh.hpp"
#include "renderer/passes/vpls/vpl_paths.hpp"

namespace candela {

/// The VPLs of a frame with their light, placed by paths or by surfels.
struct Vpls {
    ValueHandle<VplPlan> plan;
    BufferHandle<gpu::Vpl> vpls;          ///< VplPlan::vpl_count; with paths ordered by path, then bounce
    BufferHandle<gpu::FluxAccount> flux;  ///< one per path, or one for all surfels
    std::optional<BufferHandle<gpu::LitPoint>> points{};  ///< points of the surfels' cells; none with paths
};

/// Adds node `vpl-trace` (compute): traces the light paths through the BVH, places a VPL at every bounce
/// (Keller, "Instant Radiosity", 1997), and finds the edges of the surfaces that the VPLs lie on
/// (shaders/vpls/vpl_edges.comp). Depends on the plan, the BVH and the lights.
[[nodiscard]] Vpls add_vpl_trace(FrameGraph& graph, Gpu& gpu, const Tracing& tracing,
                                 ValueHandle<VplPlan> plan, BufferHandle<gpu::Light> lights);

}  // namespace candela
