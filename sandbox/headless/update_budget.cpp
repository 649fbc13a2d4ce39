#include "sandbox/headless/update_budget.hpp"

#include <algorithm>
#include <string_view>

namespace candela::sandbox {

namespace {

constexpr double least_limit = 4.0;
constexpr double most_limit = 1 << 20;

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

/// Milliseconds that grow with the number of surfels that are traced: nearly all of them are those of depth
/// maps, if there are any. A part of the time between surfels is the same for any number.
double traced_ms(const FrameReport& frame) {
    const double maps = gpu_ms(frame, "vpl-maps");
    return maps > 0.0 ? maps : gpu_ms(frame, "surfel-visibility");
}

}  // namespace

Configuration UpdateBudget::limited(Configuration configuration) const {
    if (budget_ms_ > 0.0 && configuration.vpls.updates == 0) configuration.vpls.updates = limit_;
    return configuration;
}

void UpdateBudget::learn(const FrameReport& frame) {
    if (budget_ms_ == 0.0) return;
    if (frame.waiting_surfels == 0) limit_ = moving_limit_;
    const double traced = traced_ms(frame);
    // Frames in which nothing had to wait do not tell how long as many take.
    if (frame.waiting_surfels == 0 || traced == 0.0) return;
    const bool rests = is_at_rest(frame);
    const double others = std::max(frame.cpu_ms, frame.gpu_ms) - traced;
    const double room = std::max(budget_ms_ - others, rests ? others : budget_ms_ / 3.0);
    // Times vary, and a few surfels cost more than others: no large steps while things move.
    const double factor = std::clamp(room / traced, 0.5, rests ? 4.0 : 1.5);
    limit_ = static_cast<std::uint32_t>(std::clamp(factor * limit_, least_limit, most_limit));
    if (!rests) moving_limit_ = limit_;
}

}  // namespace candela::sandbox
