#include <candela/tools/flip.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

#include <candela/tools/picture_error.hpp>

namespace candela::tools {
namespace {

constexpr double pi = std::numbers::pi;
// A screen of 3840 pixels, 0.7 m wide, seen from 0.7 m.
constexpr double pixels_per_degree = 3840.0 * pi / 180.0;

using Kernel = std::vector<double>;  // of odd length, its centre in the middle

struct Plane {
    glm::ivec2 size{0};
    std::vector<double> values;
};

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

/// Luminance Y, red-green Cx and blue-yellow Cz.
using Opponent = std::array<Plane, 3>;

// ---- Colour spaces

/// XYZ relative to the screen's white, from linear RGB with the primaries of sRGB (IEC 61966-2-1).
glm::dmat3 xyz_of_rgb() {
    const glm::dmat3 rows(0.4124, 0.3576, 0.1805, 0.2126, 0.7152, 0.0722, 0.0193, 0.1192, 0.9505);
    const glm::dmat3 xyz = glm::transpose(rows);
    const glm::dvec3 white = xyz * glm::dvec3(1.0);
    return {xyz[0] / white, xyz[1] / white, xyz[2] / white};
}

glm::dvec3 opponent_of(glm::dvec3 xyz) {
    return {116.0 * xyz.y - 16.0, 500.0 * (xyz.x - xyz.y), 200.0 * (xyz.y - xyz.z)};
}

glm::dvec3 xyz_of_opponent(glm::dvec3 colour) {
    const double y = (colour.x + 16.0) / 116.0;
    return {y + colour.y / 500.0, y, y - colour.z / 200.0};
}

Opponent opponent_planes(const Picture& picture) {
    Opponent planes;
    for (Plane& plane : planes) {
        plane.size = picture.size;
        plane.values.reserve(picture.pixels.size());
    }
    const glm::dmat3 to_xyz = xyz_of_rgb();
    for (const glm::vec3& pixel : picture.pixels) {
        const glm::dvec3 colour = opponent_of(to_xyz * glm::clamp(glm::dvec3(pixel), 0.0, 1.0));
        for (int channel = 0; channel < 3; ++channel) planes[at(channel)].values.push_back(colour[channel]);
    }
    return planes;
}

/// CIE L*a*b*, with a and b scaled by L/100 after Hunt: dark colours look less colourful.
glm::dvec3 hunt_lab(glm::dvec3 xyz) {
    constexpr double knee = 6.0 / 29.0;
    const auto f = [](double t) {
        return t > knee * knee * knee ? std::cbrt(t) : t / (3.0 * knee * knee) + 4.0 / 29.0;
    };
    const glm::dvec3 lab = opponent_of({f(xyz.x), f(xyz.y), f(xyz.z)});
    return {lab.x, 0.01 * lab.x * lab.y, 0.01 * lab.x * lab.z};
}

// ---- Filters

template <typename Weight>
Kernel sampled(double reach, Weight weight) {
    const int radius = static_cast<int>(std::ceil(reach));
    Kernel kernel;
    kernel.reserve(2 * static_cast<std::size_t>(radius) + 1);
    for (int x = -radius; x <= radius; ++x) kernel.push_back(weight(static_cast<double>(x)));
    return kernel;
}

double gaussian(double x, double sigma) {
    return std::exp(-x * x / (2.0 * sigma * sigma));
}

/// Normalises positive weights to a sum of 1 and negative weights to a sum of -1.
Kernel balanced(Kernel kernel) {
    double positive = 0.0;
    double negative = 0.0;
    for (const double weight : kernel) (weight > 0.0 ? positive : negative) += std::abs(weight);
    for (double& weight : kernel) weight /= weight > 0.0 ? positive : negative;
    return kernel;
}

/// Filters each row and transposes, so that applying it twice filters both ways. The border is extended by
/// repeating its pixels.
Plane filter_rows_and_transpose(const Plane& plane, const Kernel& kernel) {
    const auto [width, height] = std::pair(plane.size.x, plane.size.y);
    const int radius = static_cast<int>(kernel.size() / 2);
    Plane result{{height, width}, std::vector<double>(plane.values.size())};
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            double sum = 0.0;
            for (int tap = -radius; tap <= radius; ++tap) {
                sum += kernel[at(tap + radius)] *
                       plane.values[at(y * width + std::clamp(x + tap, 0, width - 1))];
            }
            result.values[at(x * height + y)] = sum;
        }
    }
    return result;
}

Plane filtered(const Plane& plane, const Kernel& along_x, const Kernel& along_y) {
    return filter_rows_and_transpose(filter_rows_and_transpose(plane, along_x), along_y);
}

// ---- Perceived colours

/// a √(π/b) exp(-π² x² / b), with x in degrees: a term of the eye's blur (the paper's "spatial filtering").
struct Lobe {
    double a, b;
};
const std::vector<Lobe> luminance_lobes{{1.0, 0.0047}};
const std::vector<Lobe> red_green_lobes{{1.0, 0.0053}};
const std::vector<Lobe> blue_yellow_lobes{{34.1, 0.04}, {13.5, 0.025}};
constexpr double widest_lobe = 0.04;

double sigma_of(double b) {
    return pixels_per_degree * std::sqrt(b / 2.0) / pi;
}

/// Convolves the plane with the sum of the lobes, which is normalised as a whole: the integral of a lobe over
/// the plane is the square of its kernel's sum.
Plane blurred(const Plane& plane, const std::vector<Lobe>& lobes) {
    Plane result{plane.size, std::vector<double>(plane.values.size())};
    double total = 0.0;
    for (const Lobe& lobe : lobes) {
        const Kernel kernel =
            sampled(3.0 * sigma_of(widest_lobe), [&](double x) { return gaussian(x, sigma_of(lobe.b)); });
        const double sum = std::accumulate(kernel.begin(), kernel.end(), 0.0);
        const double weight = lobe.a * std::sqrt(pi / lobe.b) * sum * sum;
        const Plane part = filtered(plane, balanced(kernel), balanced(kernel));
        for (std::size_t i = 0; i < part.values.size(); ++i) result.values[i] += weight * part.values[i];
        total += weight;
    }
    for (double& value : result.values) value /= total;
    return result;
}

std::vector<glm::dvec3> seen_colours(const Opponent& picture) {
    const glm::dmat3 to_xyz = xyz_of_rgb();
    const glm::dmat3 to_rgb = glm::inverse(to_xyz);
    const Plane y = blurred(picture[0], luminance_lobes);
    const Plane cx = blurred(picture[1], red_green_lobes);
    const Plane cz = blurred(picture[2], blue_yellow_lobes);
    std::vector<glm::dvec3> colours;
    colours.reserve(y.values.size());
    for (std::size_t i = 0; i < y.values.size(); ++i) {
        const glm::dvec3 rgb = to_rgb * xyz_of_opponent({y.values[i], cx.values[i], cz.values[i]});
        colours.push_back(hunt_lab(to_xyz * glm::clamp(rgb, 0.0, 1.0)));
    }
    return colours;
}

/// The HyAB distance, |ΔL| + √(Δa² + Δb²), to the power that the paper calls q_c.
double distance(glm::dvec3 a, glm::dvec3 b) {
    return std::pow(std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z), 0.7);
}

/// Maps distances to [0, 1]: the lower 0.4 of them, which are the ones that occur, to the lower 0.95 (the
/// paper's redistribution of errors).
double redistributed(double distance, double largest) {
    constexpr double knee = 0.95;
    const double start = 0.4 * largest;
    if (distance < start) return distance / start * knee;
    return knee + (distance - start) / (largest - start) * (1.0 - knee);
}

/// The distance between green and blue, the two screen colours that are farthest apart.
double largest_distance() {
    const glm::dmat3 to_xyz = xyz_of_rgb();
    return distance(hunt_lab(to_xyz[1]), hunt_lab(to_xyz[2]));
}

// ---- Perceived edges and points

constexpr double feature_sigma = 0.5 * 0.082 * pixels_per_degree;  // half an edge's width, 0.082 degrees

/// The length of the vector of the responses of `detector` along x and along y.
std::vector<double> found_by(const Kernel& detector, const Plane& luminance) {
    const Kernel smooth =
        balanced(sampled(3.0 * feature_sigma, [](double x) { return gaussian(x, feature_sigma); }));
    std::vector<double> across = filtered(luminance, detector, smooth).values;
    const std::vector<double> down = filtered(luminance, smooth, detector).values;
    std::transform(across.begin(), across.end(), down.begin(), across.begin(),
                   [](double x, double y) { return std::hypot(x, y); });
    return across;
}

/// Edges have a large first derivative of the smoothed luminance, points a large second derivative.
struct Features {
    std::vector<double> edges, points;
};

Features features_of(Plane luminance) {
    for (double& y : luminance.values) y = (y + 16.0) / 116.0;
    constexpr double reach = 3.0 * feature_sigma;
    const Kernel first = sampled(reach, [](double x) { return -x * gaussian(x, feature_sigma); });
    const Kernel second = sampled(reach, [](double x) {
        return (x * x / (feature_sigma * feature_sigma) - 1.0) * gaussian(x, feature_sigma);
    });
    return {found_by(balanced(first), luminance), found_by(balanced(second), luminance)};
}

/// In [0, 1].
double feature_difference(const Features& a, const Features& b, std::size_t pixel) {
    const double difference =
        std::max(std::abs(a.edges[pixel] - b.edges[pixel]), std::abs(a.points[pixel] - b.points[pixel]));
    return std::sqrt(difference / std::numbers::sqrt2);
}

// ---- Display

/// Narkowicz, "ACES Filmic Tone Mapping Curve", 2015; white long before light is 1e4.
glm::dvec3 filmic(glm::dvec3 light) {
    const glm::dvec3 x = glm::min(light, 1e4);
    return glm::clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
}

}  // namespace

Flip flip(const Picture& picture, const Picture& reference, std::span<const std::uint8_t> hit) {
    require_comparable(picture, reference, hit);
    const Opponent a = opponent_planes(picture);
    const Opponent b = opponent_planes(reference);
    const std::vector<glm::dvec3> a_colours = seen_colours(a);
    const std::vector<glm::dvec3> b_colours = seen_colours(b);
    const Features a_features = features_of(a[0]);
    const Features b_features = features_of(b[0]);
    const double largest = largest_distance();
    Flip result;
    result.map.reserve(a_colours.size());
    for (std::size_t i = 0; i < a_colours.size(); ++i) {
        const double colour = redistributed(distance(a_colours[i], b_colours[i]), largest);
        result.map.push_back(std::pow(colour, 1.0 - feature_difference(a_features, b_features, i)));
    }
    result.mean = mean_over(result.map.size(), hit, [&](std::size_t i) { return result.map[i]; });
    return result;
}

Flip flip_of_light(const Picture& picture, const Picture& reference, std::span<const std::uint8_t> hit) {
    require_comparable(picture, reference, hit);
    const double exposure = automatic_exposure(reference);
    return flip(displayed(picture, exposure), displayed(reference, exposure), hit);
}

double automatic_exposure(const Picture& radiance) {
    constexpr double faint = 0x1p-16;  // see ToneMapSettings
    double sum = 0.0, weights = 0.0;
    for (const glm::vec3& pixel : radiance.pixels) {
        const double luminance = glm::dot(glm::dvec3(pixel), {0.2126, 0.7152, 0.0722});
        if (!(luminance > 0.0) || !std::isfinite(luminance)) continue;
        const double weight = 1.0 / (1.0 + faint / luminance);
        sum += weight * std::log2(luminance);
        weights += weight;
    }
    return weights > 0.0 ? std::clamp(0.18 / std::exp2(sum / weights), 0x1p-10, 0x1p10) : 1.0;
}

Picture displayed(const Picture& radiance, double exposure) {
    Picture shown{radiance.size, {}};
    shown.pixels.reserve(radiance.pixels.size());
    for (const glm::vec3& pixel : radiance.pixels) {
        shown.pixels.emplace_back(filmic(exposure * glm::dvec3(pixel)));
    }
    return shown;
}

}  // namespace candela::tools
