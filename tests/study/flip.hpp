#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tests/study/measures.hpp"

namespace candela::study {

/// What an observer notices when a picture and its reference alternate on a screen: 0 nothing, 1 the most.
struct Flip {
    double mean = 0.0;        ///< over the pixels that count
    std::vector<double> map;  ///< one value a pixel, row 0 at the top
};

/// The measure for low dynamic range of Andersson et al., "ꟻLIP: A Difference Evaluator for Alternating
/// Images", 2020, for an observer who sees 67 pixels in a degree. Pixels are the screen's linear RGB, clamped
/// to [0, 1]. The map covers all pixels; those that do not count in `hit` are left out of the mean. Throws as
/// `measure` does.
[[nodiscard]] Flip flip(const sandbox::Picture& picture, const sandbox::Picture& reference,
                        std::span<const std::uint8_t> hit = {});

}  // namespace candela::study
