#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

#include <candela/configuration.hpp>
#include <candela/ecs/world.hpp>
#include <candela/report.hpp>
#include "renderer/frame/build_frame.hpp"
#include "renderer/frame/frame_budget.hpp"
#include "renderer/passes/surfels/surfel_updates.hpp"
#include "renderer/passes/view/refinement.hpp"
#include "renderer/passes/view/view.hpp"

namespace candela {

/// What a complete frame means for the next ones.
struct FrameOutcome {
    WaitingSurfels waiting{};                ///< of the set that lights the frame
    bool has_guide = false;                  ///< that may stay
    bool refines = false;                    ///< whether another frame is to be added to a mean
    std::optional<Refinement> refinement{};  ///< none: it is off
    std::optional<bool> next_waits{};  ///< whether surfels of the set that is prepared wait; none: none is
};

/// Decides what frames do besides showing the world as it is now: how many pixels they render, whether they
/// are added to a mean, whether they trace surfels that wait, and which set of surfels they show and prepare.
class FrameSchedule {
 public:
    /// Begins a frame with these views of the world; the following functions are of that frame. `budget_ms`:
    /// for a frame in which something moves, 0: no limit. The means start over if the last frame threw.
    void begin(const World& world, std::vector<ViewRequest> views, const Configuration& configuration,
               double budget_ms);
    [[nodiscard]] const Quality& quality() const { return quality_; }
    [[nodiscard]] const SurfelTurn& turn() const { return turn_; }
    [[nodiscard]] const RefinementClock& refinement_clock() const { return refinement_clock_; }
    [[nodiscard]] const UpdateClock& update_clock() const { return update_clock_; }
    /// The update clock of the last frame before which maps were outdated: all surfels are written again for
    /// each new value, which therefore has to be rare.
    [[nodiscard]] const UpdateClock& map_clock() const { return map_clock_; }
    /// Whether the guide of surfels stays: others have yet to be placed by it, or things move and it is new.
    [[nodiscard]] bool guide_waits() const { return guide_waits_; }

    /// Ends the frame. Neither is called for a frame that throws.
    void complete(const FrameOutcome& outcome);
    /// The next frame goes on with it.
    void abandon();

    /// The means start over with the next frame.
    void restart() { ++refinement_clock_.epoch; }
    /// Another graph runs the next frame. `same`: it gives the same picture.
    void change_graph(bool same);
    /// All that the last frames have found is void.
    void invalidate() { is_complete_ = false; }
    /// Learns which quality fits the budget while something moves. `configured`: see choose_quality.
    void learn(const FrameCost& cost, const Quality& measured, std::uint32_t configured, double budget_ms);

    /// Whether another frame of the same world would show the same.
    [[nodiscard]] bool settled() const {
        return is_complete_ && !abandoned_ && !waits() && !refines_ && quality_ == Quality{};
    }
    /// Surfels that waited after the last complete frame.
    [[nodiscard]] std::uint32_t waiting() const { return waiting_.now(); }

 private:
    using Clock = std::chrono::steady_clock;

    [[nodiscard]] bool waits() const { return waiting_.any() || guide_waits_; }
    [[nodiscard]] bool has_moved(const World& world, std::vector<ViewRequest> views);
    [[nodiscard]] Quality choose(bool moved, double budget_ms);
    [[nodiscard]] SurfelTurn take_turn(bool rests);

    Quality quality_;
    Quality quality_in_motion_;
    SurfelTurn turn_;
    RefinementClock refinement_clock_;
    UpdateClock update_clock_;
    UpdateClock map_clock_;
    bool guide_waits_ = false;
    std::uint32_t guide_age_ = 0;  // frames in which something has moved

    Tick last_revision_ = 0;  // the world's, in the last frame
    std::vector<ViewRequest> last_views_;
    Clock::time_point last_move_;

    bool is_complete_ = false;    // the last frame; false if it threw, or if it is void
    bool abandoned_ = false;      // the last frame was, and the next one goes on with it
    WaitingSurfels waiting_;      // FrameOutcome
    bool asks_for_more_ = false;  // of what waits
    bool refines_ = false;
    Refinement refined_;            // the last frame's
    std::uint32_t turn_begin_ = 0;  // Refinement::set when its surfels took their turn; 0: before the mean
    bool next_set_is_complete_ = false;  // that which the last frames have prepared
};

}  // namespace candela
