#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "tests/study/measures.hpp"

namespace candela::study {

/// A picture of the error per pixel, in the format of `tools::write_png`.
struct HeatMap {
    glm::ivec2 size{0};
    std::vector<std::uint8_t> rgb;  ///< sRGB-encoded, row 0 at the top
    double scale = 0.0;             ///< the relative error at the brightest colour
};

/// The sRGB-encoded colour of a value, which is clamped to [0, 1]: black through violet and orange to pale
/// yellow, with increasing lightness. Piecewise linear between samples of matplotlib's "magma".
[[nodiscard]] glm::dvec3 heat_colour(double value);

/// The relative errors (see `relative_errors`) as colours, up to `scale`, or, if not given, up to the largest
/// error. Pixels that do not count in `hit` are grey. Throws as `measure` does, and if `scale` is not above
/// 0.
[[nodiscard]] HeatMap heat_map(const tools::Picture& picture, const tools::Picture& reference,
                               std::span<const std::uint8_t> hit = {}, std::optional<double> scale = {});

}  // namespace candela::study
