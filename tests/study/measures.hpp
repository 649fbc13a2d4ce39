#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "sandbox/picture.hpp"

namespace candela::study {

/// Which pixels count: one entry a pixel, not 0 where it does; row 0 at the top.
using Mask = std::vector<std::uint8_t>;

/// Whether a pixel is in `hit`; all are where it is empty.
[[nodiscard]] inline bool counts(std::span<const std::uint8_t> hit, std::size_t pixel) {
    return hit.empty() || hit[pixel] != 0;
}

/// How far a picture of linear radiance is from its reference, over the pixels that count. a and r are a
/// pixel's RGB vectors in picture and reference, m is the reference's mean vector.
struct Errors {
    double rel_mse = 0.0;  ///< mean(|a - r|² / (|r|² + 0.01 |m|²))
    double rmse = 0.0;     ///< √mean(|a - r|²), in units of radiance
    double bias = 0.0;     ///< Σ(a - r) / Σr over pixels and channels
    double spikes = 0.0;   ///< the picture's largest channel over the reference's largest
};

/// The errors over the pixels in `hit`, or over all where it is empty. Against a black reference a black
/// picture has no error and any other an infinite one. Throws std::invalid_argument where the sizes differ, a
/// pixel is not finite or none counts.
[[nodiscard]] Errors measure(const sandbox::Picture& picture, const sandbox::Picture& reference,
                             std::span<const std::uint8_t> hit = {});

/// √(|a - r|² / (|r|² + 0.01 |m|²)) of each pixel, whose mean square is the relMSE; 0 for pixels that do not
/// count. Throws as `measure` does.
[[nodiscard]] std::vector<double> relative_errors(const sandbox::Picture& picture,
                                                  const sandbox::Picture& reference,
                                                  std::span<const std::uint8_t> hit = {});

/// How much of what changes from frame to frame is error, for each pair of consecutive frames: the relMSE
/// between their difference and that of the reference, mean(|Δa - Δr|² / (|Δr|² + 0.01 |m|²)) over the pixels
/// that count in both. m is the mean vector of all the reference's frames, not of their differences, so that
/// a still reference has a flicker as well. `hits` holds a mask a frame, or none for all pixels. Throws as
/// `measure` does, and where there are fewer than two frames.
[[nodiscard]] std::vector<double> flicker_of_pairs(std::span<const sandbox::Picture> frames,
                                                   std::span<const sandbox::Picture> reference_frames,
                                                   std::span<const Mask> hits = {});

/// The mean of `flicker_of_pairs`.
[[nodiscard]] double flicker(std::span<const sandbox::Picture> frames,
                             std::span<const sandbox::Picture> reference_frames,
                             std::span<const Mask> hits = {});

/// Throws as `measure` does, for measures of one's own.
void require_comparable(const sandbox::Picture& picture, const sandbox::Picture& reference,
                        std::span<const std::uint8_t> hit);

/// The first pixel, from the top left, that holds NaN or infinity.
[[nodiscard]] std::optional<glm::ivec2> first_not_finite(const sandbox::Picture& picture);

/// The means of squares of `factor` x `factor` pixels; what is left over at the right and below is cut off.
[[nodiscard]] sandbox::Picture scaled_down(const sandbox::Picture& picture, int factor);

}  // namespace candela::study
