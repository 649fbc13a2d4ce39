#include "renderer/facade/frame_schedule.hpp"

#include <utility>

namespace candela {

void FrameSchedule::begin(const World& world, std::vector<ViewRequest> views,
                          const Configuration& configuration, double budget_ms) {
    if (!std::exchange(is_complete_, false)) {
        restart();
        refines_ = next_set_is_complete_ = false;
    }
    const bool moved = has_moved(world, std::move(views));
    quality_ = choose(moved, budget_ms);
    const bool in_turn = takes_turns(configuration);
    turn_ = in_turn ? take_turn(!moved && quality_ == Quality{}) : SurfelTurn{};
    next_set_is_complete_ &= turn_.prepares_next;

    refinement_clock_.surfel_set = in_turn ? std::optional(refined_.surfel_set) : std::nullopt;
    if (std::exchange(refines_, false)) ++refinement_clock_.round;
    update_clock_.limit = configuration.vpls.updates;
    update_clock_.moves = moved;
    constexpr std::uint32_t frames_a_guide = 8;  // it takes up to a fifth of the time of a frame
    guide_waits_ = waiting_.to_be_placed.gains > 0 || (moved && ++guide_age_ < frames_a_guide);
    if (!guide_waits_) guide_age_ = 0;
    if (std::exchange(asks_for_more_, false)) ++update_clock_.round;
    if (waiting_.maps > 0 || map_clock_.limit == 0) map_clock_ = update_clock_;
}

void FrameSchedule::complete(const FrameOutcome& outcome) {
    is_complete_ = true;
    abandoned_ = false;
    waiting_ = outcome.waiting;
    guide_waits_ = guide_waits_ && outcome.has_guide;
    // What is worth little waits for rest, which changes the clock.
    asks_for_more_ = update_clock_.moves ? waiting_.now() > 0 : waiting_.any();
    refines_ = !waits() && outcome.refines;
    if (outcome.refinement) refined_ = *outcome.refinement;
    next_set_is_complete_ = outcome.next_waits == false;
}

void FrameSchedule::abandon() {
    is_complete_ = true;
    abandoned_ = true;
}

void FrameSchedule::change_graph(bool same) {
    if (!same || abandoned_) restart();
    if (!same) next_set_is_complete_ = false;
}

void FrameSchedule::learn(const FrameCost& cost, const Quality& measured, std::uint32_t configured,
                          double budget_ms) {
    if (budget_ms == 0.0 || cost.pixels == 0.0) return;
    quality_in_motion_ = choose_quality(cost, measured, configured, budget_ms);
}

/// Whether anything has, since the last frame.
bool FrameSchedule::has_moved(const World& world, std::vector<ViewRequest> views) {
    const bool moved = world.revision() != last_revision_ || views != last_views_;
    last_revision_ = world.revision();
    last_views_ = std::move(views);
    return moved;
}

/// Full quality, unless there is a frame budget and something moved within the last quarter of a second.
Quality FrameSchedule::choose(bool moved, double budget_ms) {
    constexpr std::chrono::milliseconds settled(250);
    const Clock::time_point now = Clock::now();
    if (moved) last_move_ = now;
    if (budget_ms == 0.0 || now - last_move_ > settled) return {};
    return moved ? quality_in_motion_ : quality_;
}

/// While nothing moves, the next set of surfels is prepared, and follows when it is complete. `rests`:
/// nothing has moved, and the quality is full.
SurfelTurn FrameSchedule::take_turn(bool rests) {
    if (refined_.set < turn_begin_) turn_begin_ = 0;
    const bool is_due = refined_.set + 1 >= turn_begin_ + frames_a_surfel_set;
    if (rests && refines_ && is_due && std::exchange(next_set_is_complete_, false)) {
        ++refined_.surfel_set;
        turn_begin_ = refined_.set + 1;
    }
    const bool goes_on = refines_ || (abandoned_ && turn_.prepares_next);
    return {.place = refined_.surfel_set % 2, .prepares_next = rests && goes_on};
}

}  // namespace candela
