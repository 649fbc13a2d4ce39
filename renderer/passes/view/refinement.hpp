#pragma once

#include <candela/configuration.hpp>

#include <cstdint>
#include <optional>
#include <vector>

#include <candela/graph/frame_graph.hpp>
#include <candela/scene/components.hpp>
#include "renderer/passes/lights/light_table.hpp"
#include "renderer/passes/scene/scene_upload.hpp"
#include "renderer/passes/view/view.hpp"

namespace candela {

/// Set by the renderer before each frame to control the refinement.
struct RefinementClock {
    std::uint64_t epoch = 0;  ///< a new value starts the means over
    std::uint64_t round = 0;  ///< a new value asks for the next set
    /// Where sets of surfels take turns, the one that lights the frame; none: Refinement::surfel_set advances
    /// by itself.
    std::optional<std::uint32_t> surfel_set;
    bool operator==(const RefinementClock&) const = default;
};

/// Averaged frames that share one set of surfels, because a new set takes several times as long as a frame.
/// Moving something during the first frames of a mean never has to wait for a new set.
inline constexpr std::uint32_t frames_a_surfel_set = 8;

/// The VPLs that a frame is rendered with, for all views. Set 0 is that of a frame without refinement. In set
/// k, VPLs on paths have the seed VplSettings::seed + k; surfels have the seed VplSettings::seed +
/// surfel_set. Any movement in the scene, or of all views, returns to set 0 but keeps surfel_set, so that the
/// visibility between surfels remains valid.
struct Refinement {
    std::uint32_t set = 0;         ///< k
    std::uint32_t surfel_set = 0;  ///< advances by 1 every frames_a_surfel_set sets, or as the clock says
    std::uint64_t epoch = 0;       ///< RefinementClock::epoch
    bool operator==(const Refinement&) const = default;
};

/// Which set of surfels passes make: that of the frame. Where sets take turns there are two places, one for
/// the sets of even and one for those of odd numbers: passes in one of them make the set of the frame, while
/// those in the other prepare the next one. Their roles change from frame to frame, but not what is in the
/// places.
struct SurfelSetChoice {
    std::optional<ValueHandle<Refinement>> refinement{};  ///< none: it is always set 0
    std::optional<std::uint32_t> place{};                 ///< 0 or 1; none: sets take no turns

    void read(Pass& pass) const;
    [[nodiscard]] std::uint32_t number(const Execution& run) const;
    /// Whether it is the set that is to light later frames.
    [[nodiscard]] bool is_next(const Execution& run) const;
};

/// Results of node `refinement`.
struct Refined {
    ValueHandle<Refinement> refinement;
    /// By view: number of frames in its mean before this one. The view is seen at this sample of the pixels:
    /// see pixel_sample. With one view it is Refinement::set.
    std::vector<ValueHandle<std::uint32_t>> averaged;
};

/// The light whose changes start the means over.
struct RefinedLight {
    ValueHandle<LightTable> lights;
    std::optional<ValueHandle<Environment>> environment;  ///< none: the world has no sky
};

/// Adds node `refinement` (CPU): advances to the next set if the scene, the lights and at least one view are
/// unchanged, and otherwise returns to set 0. The mean of a view starts over when the view moves, and all do
/// when the scene or the lights change. Depends on the clock, the scene's layout and placement, the light and
/// the views, and on its own last results.
[[nodiscard]] Refined add_refinement(FrameGraph& graph, ValueHandle<RefinementClock> clock,
                                     const SceneData& scene, const RefinedLight& light,
                                     const std::vector<ValueHandle<CameraView>>& views);

/// Adds node `refined-view` (CPU): the requested view with the samples moved to pixel_sample(averaged).
/// Depends on the request, Camera, Transform and `averaged`.
[[nodiscard]] ValueHandle<CameraView> add_refined_view(FrameGraph& graph, ValueHandle<ViewRequest> request,
                                                       ValueHandle<std::uint32_t> averaged);

}  // namespace candela
