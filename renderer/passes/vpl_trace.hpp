#pragma once

#include "engine/graph/frame_graph.hpp"
#include "renderer/gpu.hpp"
#include "renderer/passes/bvh.hpp"
#include "renderer/passes/vpl_paths.hpp"

namespace candela {

struct Vpls {
    ValueHandle<VplPaths> paths;
    BufferHandle<gpu::Vpl> vpls;  ///< `VplPaths::vpl_count` of them, in the order of paths, then bounces
    BufferHandle<gpu::FluxAccount> flux;                  ///< one a path
    std::optional<BufferHandle<gpu::LitPoint>> points{};  ///< of surfels' cells; none: VPLs were traced
};

/// What is to be traced in a frame, and what it builds on.
struct DueVpls {
    ValueHandle<VplPaths> paths;
    BufferHandle<gpu::VplRecord> records;
};

/// Bounces as they were traced, by tile; kept from frame to frame.
[[nodiscard]] BufferHandle<gpu::VplRecord> vpl_records(FrameGraph& graph);

/// Node `vpl-trace` (compute): traces what the paths do not keep, gives all VPLs their flux, and finds the
/// edges of the surfaces that they sit on.
[[nodiscard]] Vpls add_vpl_trace(FrameGraph& graph, Gpu& gpu, const Tracing& tracing, const DueVpls& due,
                                 BufferHandle<gpu::Light> lights);

}  // namespace candela
