#include "renderer/frame/frame_budget.hpp"

#include <algorithm>
#include <array>
#include <glm/common.hpp>

namespace candela {
namespace {

// From best to lowest. Interleaving comes first, because it costs hardly any quality.
constexpr std::array<Quality, 9> qualities{{{1.0F, 1},
                                            {1.0F, 8},
                                            {0.8F, 8},
                                            {0.65F, 8},
                                            {0.5F, 8},
                                            {0.4F, 8},
                                            {0.32F, 8},
                                            {0.25F, 8},
                                            lowest_quality}};

constexpr double full = 0.9;   // share of the budget that a frame of the same or lower quality may take
constexpr double roomy = 0.7;  // share of the budget that a frame of better quality may take

double pixels_of(const Quality& quality) {
    return static_cast<double>(quality.scale) * static_cast<double>(quality.scale);
}

bool is_better(const Quality& a, const Quality& b) {
    return a.scale > b.scale || (a.scale == b.scale && a.interleave < b.interleave);
}

}  // namespace

FrameCost cost_of(const FrameReport& frame) {
    FrameCost cost;
    for (const PassReport& pass : frame.passes) {
        if (!pass.ran) continue;
        if (pass.workload == Workload::pixels) {
            cost.pixels += pass.gpu_ms;
        } else if (pass.workload == Workload::pixels_vpls) {
            cost.gather += pass.gpu_ms;
        }
    }
    cost.rest = std::max(std::max(frame.cpu_ms, frame.gpu_ms) - cost.gather - cost.pixels, 0.0);
    return cost;
}

double expected_ms(const FrameCost& cost, const Quality& measured, const Quality& wanted) {
    const double pixels = pixels_of(wanted) / pixels_of(measured);
    const double asked = static_cast<double>(measured.interleave) / static_cast<double>(wanted.interleave);
    return cost.rest + pixels * (cost.pixels + asked * asked * cost.gather);
}

Quality choose_quality(const FrameCost& cost, const Quality& measured, std::uint32_t configured,
                       double budget_ms) {
    const auto fits = [&](Quality quality) {
        quality.interleave = std::max(quality.interleave, configured);
        const double room = is_better(quality, measured) ? roomy : full;
        return expected_ms(cost, measured, quality) <= room * budget_ms;
    };
    const auto* const found = std::ranges::find_if(qualities, fits);
    return found == qualities.end() ? qualities.back() : *found;
}

glm::uvec2 rendered_size(glm::uvec2 target, const Quality& quality) {
    const glm::vec2 size = glm::round(glm::vec2(target) * quality.scale);
    return glm::max(glm::uvec2(size), 1U);
}

}  // namespace candela
