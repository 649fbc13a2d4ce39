#pragma once

#include <optional>

#include "engine/graph/frame_graph.hpp"
#include "renderer/gpu.hpp"
#include "renderer/passes/bvh.hpp"
#include "renderer/passes/vpl_paths.hpp"

namespace candela {

struct Vpls {
    ValueHandle<VplPlan> plan;
    BufferHandle<gpu::Vpl> vpls;  ///< `VplPlan::vpl_count` of them, in the order of paths, then bounces
    BufferHandle<gpu::FluxAccount> flux;                  ///< one a path, or one of all surfels
    std::optional<BufferHandle<gpu::LitPoint>> points{};  ///< of surfels' cells; none: VPLs were traced
};

/// Node `vpl-trace` (compute): traces the paths, leaves a VPL at every bounce, and finds the edges of the
/// surfaces that they sit on.
[[nodiscard]] Vpls add_vpl_trace(FrameGraph& graph, Gpu& gpu, const Tracing& tracing,
                                 ValueHandle<VplPlan> plan, BufferHandle<gpu::Light> lights);

}  // namespace candela
