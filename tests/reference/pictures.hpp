#pragma once

#include <candela/tools/picture.hpp>
#include "renderer/tools/reference/path_tracer.hpp"
#include "tests/renderer/scene_builder.hpp"

namespace candela::reference {

/// The renderer's picture, whose row 0 is at the bottom, with the row order of the reference.
[[nodiscard]] tools::Picture flipped(const candela::Picture& picture);

/// 1 where `mask` is 1 and `removed` is 0.
[[nodiscard]] std::vector<std::uint8_t> without(const std::vector<std::uint8_t>& mask,
                                                const std::vector<std::uint8_t>& removed);

/// The mean of the indirect light's red channel over the pixels in `mask`. The standard error is estimated
/// from the difference of the halves; pixels are independent of each other.
struct NoisyMean {
    double value;
    double error;
};
[[nodiscard]] NoisyMean mean_indirect(const Estimate& estimate, const std::vector<std::uint8_t>& mask);

/// The mean squared error against `truth` over `mask`, divided by the one that the halves predict: 1 if the
/// prediction is right.
[[nodiscard]] double noise_ratio(const Estimate& estimate, const tools::Picture& truth,
                                 const std::vector<std::uint8_t>& mask);

/// The largest |a - b| / max(b, floor) of the red channel over `mask`.
[[nodiscard]] double worst_error(const tools::Picture& a, const tools::Picture& b,
                                 const std::vector<std::uint8_t>& mask, double floor);

}  // namespace candela::reference
