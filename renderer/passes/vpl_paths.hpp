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

/// How VPLs are placed. Names in JSON: paths, surfels.
enum class VplPlacement : std::uint8_t {
    paths,   ///< where light paths from the lights hit surfaces: Keller, "Instant Radiosity" (1997)
    surfels  ///< evenly on all surfaces, independent of the lights; they gather their light
};

/// Largest VplSettings::count with VplPlacement::surfels. The form factors between them then take 256 MiB.
inline constexpr std::uint32_t most_surfels = 65536;

/// Number and placement of VPLs.
struct VplSettings {
    VplPlacement placement = VplPlacement::surfels;
    std::uint32_t count = 512;  ///< with paths: most VPLs, up to 2^20; with surfels: about so many
    /// Most bounces, up to 64. 1: light → surface → visible surface; 0: no indirect light. Surfels stop when
    /// less than 0.1 % of the first reflected light is left.
    std::uint32_t bounces = 64;
    std::uint32_t seed = 0;  ///< of the pseudo-random placement
    bool operator==(const VplSettings&) const = default;
};

/// The VPLs of a frame. Paths, weights and bounces are set only with VplPlacement::paths, points only with
/// surfels.
struct VplPlan {
    std::vector<gpu::Path> paths;
    std::vector<float> weights;     ///< by VPL: share of its light's flux on its path, without albedos
    std::uint32_t vpl_count = 0;    ///< records of VPLs; some are empty, where paths left the scene
    std::uint32_t max_bounces = 0;  ///< of the longest path
    std::uint32_t point_count = 0;  ///< points of all cells of surfels
    bool operator==(const VplPlan&) const = default;
};

/// Plans the light paths of a frame. Lights get paths in proportion to their flux. Of the n paths of a light,
/// about the first n·ρᵏ continue to bounce k + 1, where ρ is the mean albedo of the scene; so all VPLs carry
/// about the same flux (Keller, "Instant Radiosity", 1997, section 3.1). Path j of a light always uses point
/// j of that light's sequence.
[[nodiscard]] VplPlan plan_paths(const LightTable& lights, float mean_albedo, const VplSettings& settings);

/// Adds node `vpl-paths` (CPU): plan_paths, with refinement for the current set. Depends on the lights, the
/// scene's metrics and the refinement.
[[nodiscard]] ValueHandle<VplPlan> add_vpl_paths(FrameGraph& graph, ValueHandle<SceneMetrics> metrics,
                                                 ValueHandle<LightTable> lights,
                                                 std::optional<ValueHandle<Refinement>> refinement,
                                                 const VplSettings& settings);

}  // namespace candela
