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

/// The light paths of a frame.
struct PathPlan {
    std::vector<gpu::Path> paths;
    std::vector<float> weights;     ///< by VPL: share of its light's flux on its path, without albedos
    std::uint32_t vpl_count = 0;    ///< of all paths, with those bounces before which paths leave the scene
    std::uint32_t max_bounces = 0;  ///< of the longest path
    bool operator==(const PathPlan&) const = default;
};

/// Plans the light paths of a frame. Lights get paths in proportion to their flux. Of the n paths of a light,
/// about the first n·ρᵏ continue to bounce k + 1, where ρ is the mean albedo of the scene; so all VPLs carry
/// about the same flux (Keller, "Instant Radiosity", 1997, section 3.1). Path j of a light always uses point
/// j of that light's sequence.
[[nodiscard]] PathPlan plan_paths(const LightTable& lights, float mean_albedo, const VplSettings& settings);

/// Adds node `vpl-paths` (CPU): plan_paths, with refinement for the current set. Depends on the lights, the
/// scene's metrics and the refinement.
[[nodiscard]] ValueHandle<PathPlan> add_vpl_paths(FrameGraph& graph, ValueHandle<SceneMetrics> metrics,
                                                  ValueHandle<LightTable> lights,
                                                  std::optional<ValueHandle<Refinement>> refinement,
                                                  const VplSettings& settings);

}  // namespace candela
