#pragma once

#include <cstdint>
#include <vector>

#include "engine/graph/frame_graph.hpp"
#include "renderer/gpu.hpp"
#include "renderer/passes/bvh.hpp"
#include "renderer/passes/lights.hpp"

namespace candela {

struct VplSettings {
    std::uint32_t count = 256;  ///< at most so many are placed
    std::uint32_t bounces = 3;  ///< 1: light → surface → seen surface
    std::uint32_t seed = 0;
    bool operator==(const VplSettings&) const = default;
};

/// Which paths are traced from which lights, and where their VPLs go.
struct VplPaths {
    std::vector<gpu::Path> paths;
    /// Weight of a path that goes on after bounce i + 1: paths that get so far, per path that gets further.
    std::vector<float> continuation;
    std::uint32_t vpl_count = 0;    ///< places for VPLs
    std::uint32_t max_bounces = 0;  ///< of the longest path
    bool operator==(const VplPaths&) const = default;
};

struct Vpls {
    ValueHandle<VplPaths> paths;
    BufferHandle<gpu::Vpl> vpls;  ///< `VplPaths::vpl_count` of them, in the order of paths, then bounces
    BufferHandle<gpu::FluxAccount> flux;  ///< one a path
};

/// Shares the VPLs out. Lights get paths in proportion to their flux; of a light's n paths the first n·ρᵏ go
/// on to bounce k + 1, ρ being the scene's mean albedo, so that all VPLs carry about the same flux: Keller,
/// "Instant Radiosity" (1997), section 3.1. Path j of a light always is point j of that light's sequence.
[[nodiscard]] VplPaths plan_paths(const LightTable& lights, float mean_albedo, const VplSettings& settings);

/// Nodes `vpl-paths` (the plan, CPU) and `vpl-trace` (compute: one invocation a path).
[[nodiscard]] Vpls add_vpl_trace(FrameGraph& graph, Gpu& gpu, const Tracing& tracing,
                                 ValueHandle<LightTable> lights, BufferHandle<gpu::Light> light_buffer,
                                 const VplSettings& settings);

}  // namespace candela
