#pragma once

#include <optional>
#include <variant>

#include <candela/graph/frame_graph.hpp>
#include "renderer/gpu/gpu_types.hpp"
#include "renderer/passes/sky/sky_vpls.hpp"
#include "renderer/passes/vpls/vpl_counts.hpp"
#include "renderer/passes/vpls/vpl_paths.hpp"

namespace candela {

/// VPLs on paths from the lights.
struct TracedVpls {
    ValueHandle<PathPlan> plan;
    BufferHandle<gpu::TracedVpl> vpls;  ///< ordered by path, then bounce
};

/// Surfels with their light.
struct LitSurfels {
    BufferHandle<gpu::LitSurfel> surfels;  ///< VplCounts::surfels
    std::optional<BufferHandle<gpu::LitEmitter>>
        emitters;                        ///< VplCounts::emitters; none: no surface emits light
    BufferHandle<gpu::LitPoint> points;  ///< of the cells of both
    std::optional<SkyPatches> sky;       ///< none: the world has no sky, or its light is not shown
    /// One surfel stands for several objects. The surfels' light is what exceeds a mean, and VPLs that are
    /// directions add the mean: shaders/README.md, "Shared items". The record behind all has the mean.
    bool balanced = false;
};

/// The VPLs of a frame with their light.
struct Vpls {
    ValueHandle<VplCounts> counts;
    BufferHandle<gpu::FluxAccount> flux;  ///< one per path; of surfels: VplCounts::accounts
    std::variant<TracedVpls, LitSurfels> records;
};

}  // namespace candela
