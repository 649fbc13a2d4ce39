#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <candela/tools/picture_error.hpp>

namespace candela::study {

using tools::counts;
using tools::first_not_finite;
using tools::Halves;
using tools::Mask;
using tools::require_comparable;

/// The difference between a picture of linear radiance and its reference, over the pixels that count. a and r
/// are the RGB vectors of a pixel in the picture and in the reference.
struct Errors {
    double rel_mse = 0.0;  ///< see tools::relative_mse
    double rmse = 0.0;     ///< √mean(|a - r|²), in units of radiance
    double bias = 0.0;     ///< Σ(a - r) / Σr over pixels and channels
    double spikes = 0.0;   ///< the picture's largest channel divided by the reference's largest
    double blotch = 0.0;   ///< see tools::blotch
};

/// The errors over the pixels in `hit`, or over all pixels if it is empty. If the reference is black, the
/// error of a black picture is 0 and that of any other is infinite. Throws as tools::relative_mse does.
[[nodiscard]] Errors measure(const tools::Picture& picture, const tools::Picture& reference,
                             std::span<const std::uint8_t> hit = {});

/// The same against the mean of the halves, whose noise is no part of the squares: see tools::Halves.
[[nodiscard]] Errors measure(const tools::Picture& picture, const Halves& reference,
                             std::span<const std::uint8_t> hit = {});

/// The reference that the halves are of.
[[nodiscard]] tools::Picture mean_of(const Halves& halves);

/// √(|a - r|² / (|r|² + 0.01 |m|²)) of each pixel; the mean of its square is the relMSE. 0 for pixels that do
/// not count. Throws as `measure` does.
[[nodiscard]] std::vector<double> relative_errors(const tools::Picture& picture,
                                                  const tools::Picture& reference,
                                                  std::span<const std::uint8_t> hit = {});

/// The error of the change from frame to frame, for each pair of consecutive frames: the relMSE between the
/// difference of the frames and that of the reference, mean((Δa - Δp) · (Δa - Δq) / (|Δr|² + 0.01 |m|²)) over
/// the pixels that count in both frames, with the halves p and q of the reference r. m is the mean vector of
/// all frames of the reference, not of their differences, so that flicker is also defined for a still
/// reference. `hits` contains one mask per frame, or is empty for all pixels. Throws as `measure` does, and
/// if there are fewer than two frames.
[[nodiscard]] std::vector<double> flicker_of_pairs(std::span<const tools::Picture> frames,
                                                   std::span<const Halves> reference_frames,
                                                   std::span<const Mask> hits = {});

/// The mean of `flicker_of_pairs`.
[[nodiscard]] double flicker(std::span<const tools::Picture> frames, std::span<const Halves> reference_frames,
                             std::span<const Mask> hits = {});

/// The relMSE of the means of blocks of 6 × 6 pixels, taken over the pixels in `hit`. A block counts if half
/// of its pixels do; none if no block does. `hit` has one element for each pixel. Throws as `measure` does.
[[nodiscard]] std::optional<double> rel_mse_of_blocks(const tools::Picture& picture, const Halves& reference,
                                                      const Mask& hit);

/// The means of blocks of `factor` x `factor` pixels; incomplete blocks at the right and at the bottom are
/// dropped.
[[nodiscard]] tools::Picture scaled_down(const tools::Picture& picture, int factor);

}  // namespace candela::study
