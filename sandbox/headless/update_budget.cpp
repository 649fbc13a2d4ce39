#include "sandbox/headless/update_budget.hpp"

#include <algorithm>
#include <string_view>

namespace candela::sandbox {

namespace {

constexpr double least_limit = 4.0;
constexpr double most_limit = 1 << 20;
constexpr double longest_ms = 250.0;  // for depth maps at rest: a frame that is given up first ends a pass

/// The pass of that name if it ran, else null.
const PassReport* find_run(const FrameReport& frame, std::string_view name) {
    const auto pass = std::ranges::find(frame.passes, name, &PassReport::name);
    return pass != frame.passes.end() && pass->ran ? &*pass : nullptr;
}

double gpu_ms(const FrameReport& frame, std::string_view name) {
    const PassReport* const pass = find_run(frame, name);
    return pass != nullptr ? pass->gpu_ms : 0.0;
}

/// The node that reads the world runs if anything in it has changed.
bool is_at_rest(const FrameReport& frame) {
    return find_run(frame, "scene-gather") == nullptr;
}

/// Milliseconds of the passes that trace surfels. A part of `between` is the same for any number of them.
struct TracingTimes {
    double maps = 0.0;     // depth maps
    double between = 0.0;  // form factors

    explicit TracingTimes(const FrameReport& frame)
        : maps(gpu_ms(frame, "vpl-maps")), between(gpu_ms(frame, "surfel-visibility")) {}

    /// Grows with their number: nearly all of it is that of depth maps, if there are any.
    [[nodiscard]] double growing() const { return maps > 0.0 ? maps : between; }
};

}  // namespace

Configuration UpdateBudget::limited(Configuration configuration) const {
    if (budget_ms_ > 0.0 && configuration.vpls.updates == 0) configuration.vpls.updates = limit_;
    return configuration;
}

void UpdateBudget::learn(const FrameReport& frame) {
    if (budget_ms_ == 0.0) return;
    if (frame.waiting_surfels == 0) limit_ = moving_limit_;
    const TracingTimes tracing(frame);
    const double traced = tracing.growing();
    // Frames in which nothing had to wait do not tell how long as many take.
    if (frame.waiting_surfels == 0 || traced == 0.0) return;
    const bool rests = is_at_rest(frame);
    const double whole = std::max(frame.cpu_ms, frame.gpu_ms);
    const double others = whole - traced;
    const double untraced = whole - tracing.maps - tracing.between;
    const double room =
        std::max(budget_ms_ - others, rests ? std::min(untraced, longest_ms) : budget_ms_ / 3.0);
    // Times vary, and a few surfels cost more than others: no large steps while things move.
    const double factor = std::clamp(room / traced, 0.5, rests ? 4.0 : 1.5);
    limit_ = static_cast<std::uint32_t>(std::clamp(factor * limit_, least_limit, most_limit));
    if (!rests) moving_limit_ = limit_;
}

}  // namespace candela::sandbox
