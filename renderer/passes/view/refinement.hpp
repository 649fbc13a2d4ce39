#pragma once

#include <candela/configuration.hpp>

#include <cstdint>
#include <optional>

#include <candela/graph/frame_graph.hpp>
#include <candela/scene/components.hpp>
#include "renderer/passes/lights/lights.hpp"
#include "renderer/passes/scene/scene_upload.hpp"
#include "renderer/passes/view/view.hpp"

namespace candela {

/// Set by the renderer before each frame to control the refinement.
struct RefinementClock {
    std::uint64_t epoch = 0;  ///< a new value starts the mean over
    std::uint64_t round = 0;  ///< a new value asks for the next set
    bool operator==(const RefinementClock&) const = default;
};

/// Averaged frames that share one set of surfels, because a new set takes several times as long as a frame.
/// Moving something during the first frames of a mean never has to wait for a new set.
inline constexpr std::uint32_t frames_a_surfel_set = 8;

/// The samples that a frame is rendered with. Set 0 is that of a frame without refinement. Set k is seen at
/// sample k of the pixels: see pixel_sample. VPLs on paths then have the seed VplSettings::seed + k; surfels
/// have the seed VplSettings::seed + surfel_set. Any movement returns to set 0 but keeps surfel_set, so that
/// the visibility between surfels remains valid.
struct Refinement {
    std::uint32_t set = 0;         ///< k; also the number of frames in the mean before this one
    std::uint32_t surfel_set = 0;  ///< advances by 1 every frames_a_surfel_set sets of a mean
    std::uint64_t epoch = 0;       ///< RefinementClock::epoch
    bool operator==(const Refinement&) const = default;
};

/// The light whose changes start the mean over.
struct RefinedLight {
    ValueHandle<LightTable> lights;
    std::optional<ValueHandle<Environment>> environment;  ///< none: the world has no sky
};

/// Adds node `refinement` (CPU): advances to the next set if the scene, the lights and the view are
/// unchanged, and otherwise returns to set 0. Depends on the clock, the scene's layout and placement, the
/// light and the view, and on its own last result.
[[nodiscard]] ValueHandle<Refinement> add_refinement(FrameGraph& graph, ValueHandle<RefinementClock> clock,
                                                     const SceneData& scene, const RefinedLight& light,
                                                     ValueHandle<CameraView> view);

/// Adds node `refined-view` (CPU): the requested view with the samples moved to pixel_sample of the current
/// set. Depends on the request, Camera, Transform and the refinement.
[[nodiscard]] ValueHandle<CameraView> add_refined_view(FrameGraph& graph, ValueHandle<ViewRequest> request,
                                                       ValueHandle<Refinement> refinement);

}  // namespace candela
