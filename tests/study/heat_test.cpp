#include "tests/study/heat.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <doctest/doctest.h>

#include "tests/study/test_pictures.hpp"

namespace candela::study {

TEST_SUITE("heat map") {

using tools::Picture;

namespace {

using Colour = std::vector<int>;

Colour colour_at(const HeatMap& map, std::size_t pixel) {
    return {map.rgb[3 * pixel], map.rgb[3 * pixel + 1], map.rgb[3 * pixel + 2]};
}

Colour bytes_of(double value) {
    const glm::dvec3 colour = heat_colour(value) * 255.0;
    return {static_cast<int>(std::lround(colour.r)), static_cast<int>(std::lround(colour.g)),
            static_cast<int>(std::lround(colour.b))};
}

/// Relative luminance of an sRGB-encoded colour (IEC 61966-2-1).
double luminance(glm::dvec3 encoded) {
    const auto decode = [](double c) {
        return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
    };
    return 0.2126 * decode(encoded.r) + 0.7152 * decode(encoded.g) + 0.0722 * decode(encoded.b);
}

/// Adds errors of 0, 1, 2 and 4 times `step` to the four pixels of the reference.
Picture errors_on(const Picture& reference, float step) {
    Picture picture = reference;
    picture.pixels[1] += step;
    picture.pixels[2] += 2.0F * step;
    picture.pixels[3] += 4.0F * step;
    return picture;
}

const Picture reference = constant({2, 2}, glm::vec3(1.0F));

}  // namespace

TEST_CASE("the ramp goes from near black to pale yellow, lighter with every step") {
    CHECK(luminance(heat_colour(0.0)) < 0.001);
    CHECK(luminance(heat_colour(1.0)) > 0.9);
    double last = luminance(heat_colour(0.0));
    for (int step = 1; step <= 255; ++step) {
        const double next = luminance(heat_colour(step / 255.0));
        CAPTURE(step);
        CHECK(next > last);
        last = next;
    }
}

TEST_CASE("values outside the ramp have the colours of its ends") {
    CHECK(heat_colour(-1.0) == heat_colour(0.0));
    CHECK(heat_colour(2.0) == heat_colour(1.0));
    CHECK(heat_colour(std::numeric_limits<double>::infinity()) == heat_colour(1.0));
}

TEST_CASE("without a scale the largest error has the brightest colour") {
    const HeatMap map = heat_map(errors_on(reference, 0.25F), reference);
    CHECK(map.size == glm::ivec2(2, 2));
    // √(3 · 1² / (3 · 1.01)).
    CHECK(map.scale == doctest::Approx(1.0 / std::sqrt(1.01)));
    CHECK(colour_at(map, 0) == bytes_of(0.0));
    CHECK(colour_at(map, 1) == bytes_of(0.25));
    CHECK(colour_at(map, 2) == bytes_of(0.5));
    CHECK(colour_at(map, 3) == bytes_of(1.0));
}

TEST_CASE("with a scale, errors above it have the brightest colour") {
    const double scale = 0.5 / std::sqrt(1.01);
    const HeatMap map = heat_map(errors_on(reference, 0.25F), reference, {}, scale);
    CHECK(map.scale == scale);
    CHECK(colour_at(map, 1) == bytes_of(0.5));
    CHECK(colour_at(map, 2) == bytes_of(1.0));
    CHECK(colour_at(map, 3) == bytes_of(1.0));
}

TEST_CASE("pixels outside the mask are grey and do not affect the scale") {
    const Mask hit{1, 1, 1, 0};
    const HeatMap map = heat_map(errors_on(reference, 0.25F), reference, hit);
    CHECK(map.scale == doctest::Approx(0.5 / std::sqrt(1.01)));
    CHECK(colour_at(map, 2) == bytes_of(1.0));
    CHECK(colour_at(map, 3) == Colour{128, 128, 128});
}

TEST_CASE("no error has the darkest colour, an infinite error the brightest") {
    const HeatMap cold = heat_map(reference, reference);
    CHECK(cold.scale == 0.0);
    for (std::size_t pixel = 0; pixel < 4; ++pixel) CHECK(colour_at(cold, pixel) == bytes_of(0.0));
    const Picture black = constant({2, 2}, glm::vec3(0.0F));
    Picture lit = black;
    lit.pixels[2] = glm::vec3(1.0F);
    const HeatMap hot = heat_map(lit, black);
    CHECK(colour_at(hot, 0) == bytes_of(0.0));
    CHECK(colour_at(hot, 2) == bytes_of(1.0));
}

TEST_CASE("invalid scales are refused") {
    for (const double scale : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
        CHECK_THROWS_AS((void)heat_map(reference, reference, {}, scale), std::invalid_argument);
    }
}
}  // TEST_SUITE("heat map")

}  // namespace candela::study
