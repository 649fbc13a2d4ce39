#pragma once

#include <candela/configuration.hpp>

#include <cstdint>
#include <optional>
#include <vector>

#include <candela/graph/frame_graph.hpp>
#include "renderer/gpu/gpu_types.hpp"
#include "renderer/passes/lights/light_table.hpp"
#include "renderer/passes/scene/bvh.hpp"
#include "renderer/passes/view/refinement.hpp"

namespace candela {

/// The VPLs of a frame: on paths, or surfels.
struct VplPlan {
    std::vector<gpu::Path> paths;
    std::vector<float> weights;        ///< by VPL: share of its light's flux on its path, without albedos
    std::uint32_t vpl_count = 0;       ///< records of VPLs; some are empty, where paths left the scene
    std::uint32_t max_bounces = 0;     ///< of the longest path
    std::uint32_t point_count = 0;     ///< points of all cells of surfels
    std::uint32_t emitting_count = 0;  ///< surfels that emit light: the last ones, but for the sky
    std::uint32_t sky_count = 0;       ///< patches of the sky: the last ones
    bool operator==(const VplPlan&) const = default;

    /// VPLs that may have depth maps: the first ones.
    [[nodiscard]] std::uint32_t mapped_count() const { return vpl_count - emitting_count - sky_count; }
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
