#pragma once

#include <cstdint>

#include <glm/vec2.hpp>

#include <candela/report.hpp>

namespace candela {

/// Time of a frame in milliseconds, by what it grows with.
struct FrameCost {
    double gather = 0.0;  ///< with rendered pixels times VPLs that each evaluates
    double pixels = 0.0;  ///< with rendered pixels only
    double rest = 0.0;    ///< with neither
};

/// Splits the times of a measured frame by the passes' workload. Only passes that ran count. `rest` is the
/// remainder of the frame's CPU or GPU time, whichever is longer; it includes time between passes.
[[nodiscard]] FrameCost cost_of(const FrameReport& frame);

/// Expected time in milliseconds of a frame with quality `wanted`, given the cost of a frame with quality
/// `measured`: rest + p · (pixels + g² · gather), with p the ratio of the pixel counts (wanted / measured)
/// and g the ratio of the interleave factors (measured / wanted).
[[nodiscard]] double expected_ms(const FrameCost& cost, const Quality& measured, const Quality& wanted);

/// Has the passes of all qualities but the best.
inline constexpr Quality lowest_quality{0.2F, 8};

/// The best quality whose expected time fits the budget, based on one measured frame; the lowest quality if
/// none fits. A better quality than the measured one must fit with a larger margin, so that the choice does
/// not oscillate. `configured`: the interleave factor that the configuration asks for, a lower bound.
[[nodiscard]] Quality choose_quality(const FrameCost& cost, const Quality& measured, std::uint32_t configured,
                                     double budget_ms);

/// Size in pixels of the picture that is rendered for a target of size `target`; at least 1 × 1.
[[nodiscard]] glm::uvec2 rendered_size(glm::uvec2 target, const Quality& quality);

}  // namespace candela
