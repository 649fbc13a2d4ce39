#pragma once

#include "sandbox/picture.hpp"
#include "tests/reference/path_tracer.hpp"
#include "tests/renderer/scene_builder.hpp"

namespace candela::reference {

/// The renderer's picture, whose row 0 is at the bottom, as the reference has it.
[[nodiscard]] sandbox::Picture flipped(const candela::Picture& picture);

/// Where both are 1 and 0, respectively.
[[nodiscard]] std::vector<std::uint8_t> without(const std::vector<std::uint8_t>& mask,
                                                const std::vector<std::uint8_t>& removed);

/// A mean over the pixels in `mask` of the indirect light's first channel, with its standard error, both from
/// what the halves differ by. Pixels are independent of each other.
struct NoisyMean {
    double value;
    double error;
};
[[nodiscard]] NoisyMean mean_indirect(const Estimate& estimate, const std::vector<std::uint8_t>& mask);

/// Mean over `mask` of the squared error against `truth`, divided by the mean of what the halves say it is: 1
/// for a reference that knows its noise.
[[nodiscard]] double noise_ratio(const Estimate& estimate, const sandbox::Picture& truth,
                                 const std::vector<std::uint8_t>& mask);

/// Largest |a - b| / max(b, floor) of the first channel over `mask`.
[[nodiscard]] double worst_error(const sandbox::Picture& a, const sandbox::Picture& b,
                                 const std::vector<std::uint8_t>& mask, double floor);

}  // namespace candela::reference
