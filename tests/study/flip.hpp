#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tests/study/measures.hpp"

namespace candela::study {

/// The difference that an observer notices when a picture and its reference alternate on a screen; 0 to 1.
struct Flip {
    double mean = 0.0;        ///< over the pixels that count
    std::vector<double> map;  ///< one value per pixel, row 0 at the top
};

/// The measure for low dynamic range of Andersson et al., "ꟻLIP: A Difference Evaluator for Alternating
/// Images", 2020, for an observer who sees 67 pixels per degree. Pixels are linear RGB of the screen, clamped
/// to [0, 1]. The map covers all pixels; the mean excludes those that do not count in `hit`. Throws as
/// `measure` does.
[[nodiscard]] Flip flip(const tools::Picture& picture, const tools::Picture& reference,
                        std::span<const std::uint8_t> hit = {});

}  // namespace candela::study
