#include "tests/study/heat.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <glm/common.hpp>

namespace candela::study {
namespace {

constexpr std::array<glm::dvec3, 9> knots{{
    {0.001, 0.000, 0.014},
    {0.113, 0.065, 0.277},
    {0.317, 0.072, 0.485},
    {0.513, 0.148, 0.508},
    {0.716, 0.215, 0.475},
    {0.904, 0.320, 0.388},
    {0.987, 0.536, 0.382},
    {0.997, 0.770, 0.535},
    {0.987, 0.991, 0.750},
}};
constexpr glm::dvec3 off_mask(0.5);  // grey, which is not a colour of the ramp

double chosen_scale(std::span<const double> errors, std::optional<double> scale) {
    if (!scale) return *std::max_element(errors.begin(), errors.end());
    if (!(*scale > 0.0 && std::isfinite(*scale))) {
        throw std::invalid_argument("the scale of a heat map is above 0");
    }
    return *scale;
}

/// Without any error the result is 0. With an infinite scale, only infinite errors give 1.
double heat_of(double error, double scale) {
    if (error == scale) return scale > 0.0 ? 1.0 : 0.0;
    return error / scale;
}

void append(std::vector<std::uint8_t>& bytes, glm::dvec3 colour) {
    for (int channel = 0; channel < 3; ++channel) {
        bytes.push_back(static_cast<std::uint8_t>(std::lround(colour[channel] * 255.0)));
    }
}

}  // namespace

glm::dvec3 heat_colour(double value) {
    const double position = std::clamp(value, 0.0, 1.0) * static_cast<double>(knots.size() - 1);
    const auto knot = std::min(static_cast<std::size_t>(position), knots.size() - 2);
    return glm::mix(knots[knot], knots[knot + 1], position - static_cast<double>(knot));
}

HeatMap heat_map(const tools::Picture& picture, const tools::Picture& reference,
                 std::span<const std::uint8_t> hit, std::optional<double> scale) {
    const std::vector<double> errors = relative_errors(picture, reference, hit);
    HeatMap map{picture.size, {}, chosen_scale(errors, scale)};
    map.rgb.reserve(3 * errors.size());
    for (std::size_t i = 0; i < errors.size(); ++i) {
        append(map.rgb, counts(hit, i) ? heat_colour(heat_of(errors[i], map.scale)) : off_mask);
    }
    return map;
}

}  // namespace candela::study
