#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "tests/study/measures.hpp"

namespace candela::study {

/// A picture of where the error is, as `sandbox::write_png` takes it.
struct HeatMap {
    glm::ivec2 size{0};
    std::vector<std::uint8_t> rgb;  ///< sRGB-encoded, row 0 at the top
    double scale = 0.0;             ///< the relative error that the brightest colour stands for
};

/// sRGB-encoded colour of a value in [0, 1], clamped to it: black through violet and orange to pale yellow,
/// lighter with every step. Knots of matplotlib's "magma", joined by lines.
[[nodiscard]] glm::dvec3 heat_colour(double value);

/// The relative errors (see `relative_errors`) as colours, up to `scale` or, without one, the largest of
/// them. Pixels that do not count in `hit` are grey. Throws as `measure` does, and where `scale` is not above
/// 0.
[[nodiscard]] HeatMap heat_map(const sandbox::Picture& picture, const sandbox::Picture& reference,
                               std::span<const std::uint8_t> hit = {}, std::optional<double> scale = {});

}  // namespace candela::study
