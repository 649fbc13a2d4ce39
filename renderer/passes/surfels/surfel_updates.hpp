#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <candela/graph/frame_graph.hpp>
#include "renderer/passes/surfels/surfel_focus.hpp"
#include "renderer/passes/surfels/surfels.hpp"

namespace candela {

/// What has to be traced in a frame, of the surfels' form factors and depth maps.
struct SurfelTasks {
    std::vector<std::uint32_t> of;  ///< by surfel: SURFEL_* (shaders/types.glsl), 0 if nothing
    std::vector<Box> changed;       ///< around all that has moved that surfels with SURFEL_CHANGED wait for
    std::uint64_t number = 0;       ///< counts the frames in which anything is traced
    bool operator==(const SurfelTasks&) const = default;
};

/// What is known of a surfel, which depth map and form factors are there, and what has changed since they
/// were traced.
struct TracedSurfel {
    std::uint64_t cell = 0;     ///< Surfels::cells
    std::uint64_t id = 0;       ///< Surfels::ids when it was traced
    std::uint64_t map_key = 0;  ///< SurfelMaps::keys then
    std::uint32_t map = 0;      ///< gpu::Surfel::map then
    bool in_place = false;      ///< its form factors, and those of others to it, are of where it is
    bool has_map = false;       ///< else its depth map lets no light through
    bool waits = false;         ///< it has waited since an earlier frame
    std::uint64_t step = 0;     ///< SceneMotion::step of which its map and form factors are
    float urgency = 0.0F;       ///< sum over the frames in which it waited: see add_surfel_updates
    bool operator==(const TracedSurfel&) const = default;
};

/// How many surfels wait for a later frame.
struct WaitingSurfels {
    std::uint32_t to_be_traced = 0;
    std::uint32_t maps = 0;      ///< SurfelMaps::outdated
    ChangesLeft to_be_placed{};  ///< where others should be
    /// Because the limit is reached: what is worth little waits for rest.
    [[nodiscard]] std::uint32_t now() const { return to_be_traced + maps + to_be_placed.gains; }
    [[nodiscard]] bool any() const { return to_be_traced > 0 || maps > 0 || to_be_placed.all > 0; }
    bool operator==(const WaitingSurfels&) const = default;
};

struct SurfelUpdates {
    ValueHandle<SurfelTasks> tasks;
    ValueHandle<WaitingSurfels> waiting;
};

/// Adds node `surfel-updates` (CPU), which bounds the time of a frame in which things move: it decides for
/// which surfels rays are traced, at most UpdateClock::limit. The others keep the depth maps and form factors
/// that they have, also while their items move; those that have none yet send no light. A surfel's urgency
/// is its share of the light, for which its area times the density of surfels there (density_at) stands,
/// times the part of what it sees that has changed, summed over the frames in which it waits. Those that send
/// no light come first, then the most urgent ones, so that all get their turn, also while things move all the
/// time. When nothing waits, all is as if it had been traced at once. Another set of surfels is traced at
/// once. Of a set that is prepared for later frames (SurfelSetChoice::is_next), a part is traced in each
/// frame, so that it is ready in time if it is not too large. Depends on surfels, motion, foci, set and
/// clock, and on its own last result.
[[nodiscard]] SurfelUpdates add_surfel_updates(FrameGraph& graph, ValueHandle<SpreadSurfels> spread,
                                               const Surfels& surfels, const Tracing& tracing,
                                               ValueHandle<SceneMotion> motion, const SurfelFoci& foci,
                                               const SurfelSetChoice& set, ValueHandle<UpdateClock> clock);

}  // namespace candela
