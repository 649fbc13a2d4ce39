#pragma once

#include <cstdint>

#include "engine/graph/frame_graph.hpp"
#include "renderer/passes/lights.hpp"
#include "renderer/passes/scene_upload.hpp"
#include "renderer/passes/view.hpp"

namespace candela {

/// Averaging of frames while nothing moves, each with VPLs, and with a sample of the pixels, of its own.
struct RefinementSettings {
    bool enabled = false;
    std::uint32_t frames = 1024;  ///< after so many the picture stands; without VPLs after 64 at most
    bool operator==(const RefinementSettings&) const = default;
};

/// What the host tells of time.
struct RefinementClock {
    std::uint64_t epoch = 0;  ///< another one than before: the mean begins anew
    std::uint64_t round = 0;  ///< another one than before: another set of VPLs is due
    bool operator==(const RefinementClock&) const = default;
};

/// Frames in the mean that share a set of surfels, which costs some times as much as a frame does; until the
/// first next one is due a host that moves something waits for none.
inline constexpr std::uint32_t frames_a_surfel_set = 8;

/// Which set of VPLs a frame is lit by. Set 0 is that of a frame without refinement; set k has the seed
/// `VplSettings::seed` + k, of surfels + k / frames_a_surfel_set, and is seen at sample k of the pixels: see
/// pixel_sample. When something moves, paths fall back to set 0. Surfels go on from the set that they are, so
/// that none of them has to be looked at anew.
struct Refinement {
    std::uint32_t set = 0;         ///< so many sets are in the mean already
    std::uint32_t surfel_set = 0;  ///< of surfels: where something moves they stay what they are
    std::uint64_t epoch = 0;
    bool operator==(const Refinement&) const = default;
};

/// Node `refinement` (CPU): goes on to the next set in each round in which the scene, its lights and the view
/// are what they were, and else back to set 0 at once; surfels stay the set that they are.
[[nodiscard]] ValueHandle<Refinement> add_refinement(FrameGraph& graph, ValueHandle<RefinementClock> clock,
                                                     const SceneData& scene, ValueHandle<LightTable> lights,
                                                     ValueHandle<CameraView> view);

/// Node `refined-view` (CPU): the requested view, its samples moved to where this set of VPLs is seen.
[[nodiscard]] ValueHandle<CameraView> add_refined_view(FrameGraph& graph, ValueHandle<ViewRequest> request,
                                                       ValueHandle<Refinement> refinement);

}  // namespace candela
