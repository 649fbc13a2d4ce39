#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/graph/frame_graph.hpp"
#include "renderer/gpu_types.hpp"
#include "renderer/passes/bvh.hpp"
#include "renderer/passes/lights.hpp"
#include "renderer/passes/refinement.hpp"

namespace candela {

/// Where VPLs are.
enum class VplPlacement : std::uint8_t {
    paths,   ///< where paths of light from the lights meet surfaces: Keller, "Instant Radiosity" (1997)
    surfels  ///< evenly on all surfaces, whatever the lights do; they gather their light
};

struct VplSettings {
    VplPlacement placement = VplPlacement::paths;
    std::uint32_t count = 1024;  ///< at most so many are placed
    std::uint32_t bounces = 8;   ///< 1: light → surface → seen surface
    std::uint32_t seed = 0;
    std::uint32_t budget = 32;  ///< VPLs, and maps of them, that a frame may make anew; 0: all that are due
    bool operator==(const VplSettings&) const = default;
};

/// Which paths are traced from which lights, what they carry, and where their VPLs go. A VPL's place is its
/// index in the buffer of VPLs; its tile is where its record and its depth map are kept from frame to frame.
struct VplPaths {
    std::vector<gpu::Path> paths;
    std::vector<gpu::VplPlace> places;    ///< of each path's bounces
    std::uint32_t vpl_count = 0;          ///< places for VPLs
    std::uint32_t max_bounces = 0;        ///< of the longest path
    std::uint32_t seed = 0;               ///< of all sequences
    std::uint32_t point_count = 0;        ///< of the surfels' cells
    std::uint32_t map_count = 0;          ///< tiles for depth maps: `gpu::VplPlace::tile` is below it
    std::vector<std::uint32_t> maps_due;  ///< places of the VPLs whose depth maps are to be drawn
    std::uint32_t debt = 0;               ///< VPLs that are missing, and depth maps that are out of date
    std::uint32_t stale = 0;  ///< VPLs that are right, but not those that full regeneration would place
    bool operator==(const VplPaths&) const = default;
};

/// Shares the VPLs out. Lights get paths in proportion to their flux; of a light's n paths the first n·ρᵏ go
/// on to bounce k + 1, ρ being the scene's mean albedo, so that all VPLs carry about the same flux: Keller,
/// "Instant Radiosity" (1997), section 3.1. Path j of a light always is point j of that light's sequence. All
/// paths are to be traced, and all maps to be drawn.
[[nodiscard]] VplPaths plan_paths(const LightTable& lights, float mean_albedo, const VplSettings& settings);

/// Node `vpl-paths` (CPU): the plan, with refinement that of the set which is due.
[[nodiscard]] ValueHandle<VplPaths> add_vpl_paths(FrameGraph& graph, ValueHandle<SceneMetrics> metrics,
                                                  ValueHandle<LightTable> lights,
                                                  std::optional<ValueHandle<Refinement>> refinement,
                                                  const VplSettings& settings);

}  // namespace candela
