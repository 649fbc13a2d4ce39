#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <candela/api.hpp>
#include <candela/tools/picture.hpp>

namespace candela::tools {

/// Which pixels count: one entry per pixel, not 0 if it counts; row 0 at the top.
using Mask = std::vector<std::uint8_t>;

/// Whether a pixel is in `hit`; all are if it is empty.
[[nodiscard]] inline bool counts(std::span<const std::uint8_t> hit, std::size_t pixel) {
    return hit.empty() || hit[pixel] != 0;
}

/// The relative mean squared error of a picture of linear radiance over the pixels in `hit`, or over all
/// pixels if it is empty: relMSE = mean(|a - r|² / (|r|² + 0.01 |m|²)). a and r are the RGB vectors of a
/// pixel in the picture and in the reference, m is the mean vector of the reference. If the reference is
/// black, the error of a black picture is 0 and that of any other is infinite. The noise of a reference is
/// part of the error. Throws ToolError if the sizes differ, if a pixel is not finite or if no
/// pixel counts.
[[nodiscard]] CANDELA_API double relative_mse(const Picture& picture, const Picture& reference,
                                              std::span<const std::uint8_t> hit = {});

/// Two estimates of a reference whose noise is independent, as that of reference::Estimate::halves. Their
/// mean is the reference r.
using Halves = std::array<Picture, 2>;

/// The relMSE without the noise of the reference: (a - p) · (a - q) stands for |a - r|², where p and q are
/// the halves, as the expected product of independent noise is 0. An error below that noise may come out
/// negative.
[[nodiscard]] CANDELA_API double relative_mse(const Picture& picture, const Halves& reference,
                                              std::span<const std::uint8_t> hit = {});

/// The relMSE of both pictures after a blur: of what an eye sees as blotches, beams and leaks, while noise
/// and edges hardly count. The blur is Gaussian, with a standard deviation of 1/120 of the width, and takes
/// pixels in `hit` only. Throws as `relative_mse` does.
[[nodiscard]] CANDELA_API double blotch(const Picture& picture, const Picture& reference,
                                        std::span<const std::uint8_t> hit = {});
[[nodiscard]] CANDELA_API double blotch(const Picture& picture, const Halves& reference,
                                        std::span<const std::uint8_t> hit = {});

/// A picture of fewer pixels, for measures of what is larger than a pixel.
struct Blocks {
    Picture means;  ///< over the pixels of each block that count; 0 if none does
    Mask hit;       ///< the blocks of which half of the pixels count, or more
};
/// Blocks of `side` × `side` pixels, at least 1; incomplete ones at the right and at the bottom are dropped.
[[nodiscard]] CANDELA_API Blocks blocks_of(const Picture& picture, std::span<const std::uint8_t> hit,
                                           int side);

/// Throws ToolError as `relative_mse` does; for other measures.
CANDELA_API void require_comparable(const Picture& picture, const Picture& reference,
                                    std::span<const std::uint8_t> hit);

/// The first pixel, from the top left, that contains NaN or infinity.
[[nodiscard]] CANDELA_API std::optional<glm::ivec2> first_not_finite(const Picture& picture);

// The parts of the relMSE, for measures that are made of the same ones.

/// |vector|².
[[nodiscard]] CANDELA_API double square(glm::dvec3 vector);

/// part / whole; 0 divided by anything is 0, even by 0.
[[nodiscard]] inline double ratio(double part, double whole) {
    return part == 0.0 ? 0.0 : part / whole;
}

/// The squared relative error of a pixel, or of a pixel's change: |a - r|² / (|r|² + 0.01 |m|²), where
/// `mean_square` is |m|².
[[nodiscard]] CANDELA_API double relative_square(glm::dvec3 a, glm::dvec3 r, double mean_square);
/// The same against the halves p and q of r: (a - p) · (a - q) / (|r|² + 0.01 |m|²).
[[nodiscard]] CANDELA_API double relative_product(glm::dvec3 a, glm::dvec3 p, glm::dvec3 q,
                                                  double mean_square);

/// The mean of `value(pixel)` over the pixels that count.
template <typename Value>
[[nodiscard]] auto mean_over(std::size_t pixels, std::span<const std::uint8_t> hit, Value value) {
    decltype(value(std::size_t{0})) sum{};
    double count = 0.0;
    for (std::size_t i = 0; i < pixels; ++i) {
        if (!counts(hit, i)) continue;
        sum += value(i);
        count += 1.0;
    }
    return sum / count;
}

/// The mean RGB vector over the pixels that count.
[[nodiscard]] CANDELA_API glm::dvec3 mean_vector(const Picture& picture, std::span<const std::uint8_t> hit);

}  // namespace candela::tools
