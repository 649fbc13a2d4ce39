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

/// With VplPlacement::surfels. What they see of each other then takes some 256 MiB.
inline constexpr std::uint32_t most_surfels = 65536;

struct VplSettings {
    VplPlacement placement = VplPlacement::surfels;
    std::uint32_t count = 512;  ///< at most so many are placed on paths, about so many surfels
    /// At most; 1: light → surface → seen surface. Surfels end where less than 0.1 % is left.
    std::uint32_t bounces = 64;
    std::uint32_t seed = 0;
    bool operator==(const VplSettings&) const = default;
};

/// The VPLs of a frame, and with VplPlacement::paths the paths of light that place them.
struct VplPlan {
    std::vector<gpu::Path> paths;
    std::vector<float> weights;   ///< share of its light's flux that a path carries into each of its bounces
    std::uint32_t vpl_count = 0;  ///< at most; some paths end early
    std::uint32_t max_bounces = 0;  ///< of the longest path
    std::uint32_t point_count = 0;  ///< of the surfels' cells
    bool operator==(const VplPlan&) const = default;
};

/// Shares the VPLs out. Lights get paths in proportion to their flux; of a light's n paths the first n·ρᵏ go
/// on to bounce k + 1, ρ being the scene's mean albedo, so that all VPLs carry about the same flux: Keller,
/// "Instant Radiosity" (1997), section 3.1. Path j of a light always is point j of that light's sequence.
[[nodiscard]] VplPlan plan_paths(const LightTable& lights, float mean_albedo, const VplSettings& settings);

/// Node `vpl-paths` (CPU): the plan, with refinement that of the set which is due.
[[nodiscard]] ValueHandle<VplPlan> add_vpl_paths(FrameGraph& graph, ValueHandle<SceneMetrics> metrics,
                                                 ValueHandle<LightTable> lights,
                                                 std::optional<ValueHandle<Refinement>> refinement,
                                                 const VplSettings& settings);

}  // namespace candela
