#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include <glm/vec2.hpp>

#include "renderer/frame_report.hpp"

namespace candela {

/// What a frame is rendered with where time is short.
struct Quality {
    float scale = 1.0F;            ///< of the target's sides: so much of them is rendered, and scaled up
    std::uint32_t interleave = 1;  ///< at least: see `interleaving`
    bool operator==(const Quality&) const = default;
};

/// What of a frame's time depends on what, in milliseconds.
struct FrameCost {
    double gather = 0.0;  ///< on pixels, and on how many VPLs each asks
    double pixels = 0.0;  ///< on pixels alone
    double rest = 0.0;    ///< on neither
};

/// Names of the passes whose time is in proportion to the pixels rendered, but for the gathering of VPLs.
[[nodiscard]] std::span<const std::string_view> pixel_passes();

/// Whose passes ran; the time that nobody measured, on the CPU or between passes, is part of the rest.
[[nodiscard]] FrameCost cost_of(const FrameReport& frame);

/// What the frame would take with another quality.
[[nodiscard]] double expected_ms(const FrameCost& cost, const Quality& measured, const Quality& wanted);

/// The best quality whose frames are expected to keep to the budget, going by a frame that was measured; the
/// least there is if none is. A better one than the measured is taken only where it leaves room, so that none
/// is left again at once. `configured`: the interleaving that frames have at least.
[[nodiscard]] Quality choose_quality(const FrameCost& cost, const Quality& measured, std::uint32_t configured,
                                     double budget_ms);

/// Pixels that are rendered for a target, at least one.
[[nodiscard]] glm::uvec2 rendered_size(glm::uvec2 target, const Quality& quality);

}  // namespace candela
