#pragma once

#include <cstdint>

#include <candela/configuration.hpp>
#include <candela/report.hpp>

namespace candela::sandbox {

/// Turns the time that a frame may take into VplSettings::updates, by how long the frames before it took.
class UpdateBudget {
 public:
    /// Milliseconds for a frame; 0: no limit.
    explicit UpdateBudget(double ms = 0.0) : budget_ms_(ms) {}

    [[nodiscard]] double budget_ms() const { return budget_ms_; }
    /// How many surfels may be traced in the next frame.
    [[nodiscard]] std::uint32_t limit() const { return limit_; }
    /// The configuration for the next frame: with the limit, unless it has one or there is no budget.
    [[nodiscard]] Configuration limited(Configuration configuration) const;

    /// Changes the limit by the times of a frame that was rendered with it. What the other passes leave of
    /// the budget is for tracing, at least a third of it, so that light also follows where they take all the
    /// time. While the world is at rest, depth maps may take as long as what is not traced, at most a
    /// quarter of a second: frames that follow nothing then need not be short, and the picture is soon
    /// complete.
    void learn(const FrameReport& frame);

 private:
    double budget_ms_ = 0.0;
    std::uint32_t limit_ = 16;
    std::uint32_t moving_limit_ = 16;  // what the limit is again once nothing waits
};

}  // namespace candela::sandbox
