#include <candela/tools/flip.hpp>
#include <candela/tools/picture_error.hpp>

#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include <candela/tools/tool_error.hpp>
#include "tests/study/test_pictures.hpp"

namespace candela::study {

TEST_SUITE("flip") {

using tools::flip;
using tools::Flip;
using tools::Mask;
using tools::Picture;

namespace {

const glm::ivec2 shape(24, 15);

Picture grey(float value) {
    return constant(shape, glm::vec3(value));
}

/// A chequerboard of black and white squares of `side` pixels.
Picture chequered(int side) {
    Picture picture{{96, 96}, {}};
    for (int y = 0; y < 96; ++y) {
        for (int x = 0; x < 96; ++x) {
            picture.pixels.emplace_back((x / side + y / side) % 2 == 0 ? 0.0F : 1.0F);
        }
    }
    return picture;
}

Picture transposed(const Picture& picture) {
    Picture result{{picture.size.y, picture.size.x}, {}};
    for (int x = 0; x < picture.size.x; ++x) {
        for (int y = 0; y < picture.size.y; ++y) {
            result.pixels.push_back(picture.pixels[static_cast<std::size_t>(y * picture.size.x + x)]);
        }
    }
    return result;
}

/// FLIP, according to the paper, of a lightness difference between uniform greys.
double flat_difference(double lightness) {
    // Green and blue according to tables of CIE L*a*b*, (87.73, -86.18, 83.18) and (32.30, 79.19, -107.86),
    // have a distance |ΔL| + √(Δa² + Δb²) of 203.3, with a and b scaled by L/100.
    const double largest = std::pow(203.3, 0.7);
    const double distance = std::pow(lightness, 0.7);
    if (distance < 0.4 * largest) return 0.95 * distance / (0.4 * largest);
    return 0.95 + 0.05 * (distance - 0.4 * largest) / (0.6 * largest);
}

}  // namespace

TEST_CASE("a picture does not differ from itself") {
    const Flip same = flip(noise(shape, 1), noise(shape, 1));
    CHECK(same.mean == 0.0);
    CHECK(*std::max_element(same.map.begin(), same.map.end()) == 0.0);
}

TEST_CASE("green and blue have the largest difference that is possible") {
    const Flip far = flip(constant(shape, {0.0F, 1.0F, 0.0F}), constant(shape, {0.0F, 0.0F, 1.0F}));
    CHECK(far.mean == doctest::Approx(1.0).epsilon(1e-9));
}

TEST_CASE("flat greys differ only by their lightness") {
    // The two decimals of a and b in the table are 1e-4 of the distance.
    CHECK(flip(grey(0.0F), grey(1.0F)).mean == doctest::Approx(flat_difference(100.0)).epsilon(1e-3));
    const auto lightness = [](double y) { return 116.0 * std::cbrt(y) - 16.0; };
    for (const float y : {0.1F, 0.18F, 0.5F}) {
        CAPTURE(y);
        CHECK(flip(grey(y), grey(1.0F)).mean ==
              doctest::Approx(flat_difference(100.0 - lightness(y))).epsilon(1e-3));
    }
    // Below (6/29)³, lightness is linear with a slope of 903.3.
    CHECK(flip(grey(0.004F), grey(0.0F)).mean ==
          doctest::Approx(flat_difference(0.004 * 903.3)).epsilon(1e-3));
}

TEST_CASE("it grows with contrast, and stays equal if picture and reference are swapped") {
    double last = 0.0;
    for (const float contrast : {0.01F, 0.05F, 0.1F, 0.2F, 0.4F}) {
        Picture picture = grey(0.5F);
        for (std::size_t i = 0; i < picture.pixels.size(); i += 7) picture.pixels[i] += contrast;
        const Flip seen = flip(picture, grey(0.5F));
        CHECK(seen.mean > last);
        CHECK(flip(grey(0.5F), picture).map == seen.map);
        last = seen.mean;
    }
}

TEST_CASE("rows and columns are treated equally") {
    const Picture a = noise(shape, 1);
    const Picture b = noise(shape, 2);
    // Sums in another order: rounding errors of doubles, after a power and a difference.
    CHECK(flip(transposed(a), transposed(b)).mean == doctest::Approx(flip(a, b).mean).epsilon(1e-9));
}

TEST_CASE("detail that is too fine to be seen counts less than coarse detail") {
    const Picture flat = constant({96, 96}, glm::vec3(0.5F));
    const double fine = flip(chequered(1), flat).mean;
    const double coarse = flip(chequered(12), flat).mean;
    // A pixel is 1/67 of a degree: 33 cycles per degree, near the limit of the eye.
    CHECK(fine < 0.25 * coarse);
}

TEST_CASE("the difference of a single bright point agrees with its closed form") {
    Picture point = constant({21, 21}, glm::vec3(0.0F));
    point.pixels[10 * 21 + 10] = glm::vec3(1.0F);
    const Flip seen = flip(point, constant({21, 21}, glm::vec3(0.0F)));

    const double pi = std::acos(-1.0);
    const double degree = 3840.0 * pi / 180.0;  // pixels
    // Its light is spread by a Gaussian, whose peak is 1/(2πσ²).
    const double eye = degree * std::sqrt(0.0047 / 2.0) / pi;
    const double colour = flat_difference(116.0 * std::cbrt(1.0 / (2.0 * pi * eye * eye)) - 16.0);
    // In the middle, the edge detector gives 0. The point detector is the second derivative of a Gaussian
    // along one axis, whose negative part has the integral 2σ/√e, times a Gaussian with a peak of
    // 1/(σ√2π).
    const double sigma = 0.041 * degree;
    const double feature = std::exp(0.5) / (2.0 * sigma) / (sigma * std::sqrt(2.0 * pi));
    // The sums approximate integrals. They are off by at most 1 % where a kernel changes its sign, which
    // the power reduces to at most 0.1 %.
    CHECK(seen.map[10 * 21 + 10] ==
          doctest::Approx(std::pow(colour, 1.0 - std::sqrt(feature))).epsilon(0.002));
    CHECK(seen.map[0] < 1e-6);
}

TEST_CASE("differences of pictures of all colours agree with a second implementation") {
    // The expected values were computed with NumPy, with dense two-dimensional kernels instead of
    // separable ones.
    Picture a{{9, 6}, {}};
    Picture b{{9, 6}, {}};
    for (int y = 0; y < 6; ++y) {
        for (int x = 0; x < 9; ++x) {
            const glm::vec2 at(static_cast<float>(x) / 8.0F, static_cast<float>(y) / 5.0F);
            a.pixels.emplace_back(at.x, at.y, static_cast<float>(x * y % 7) / 6.0F);
            b.pixels.emplace_back(at.y, at.x, static_cast<float>((x + y) % 5) / 4.0F);
        }
    }
    // The floats of the pixels have a rounding error of 6e-8.
    const Flip seen = flip(a, b);
    CHECK(seen.mean == doctest::Approx(0.8064487712).epsilon(1e-6));
    CHECK(seen.map[0] == doctest::Approx(0.6781581757).epsilon(1e-6));
    CHECK(seen.map[2 * 9 + 3] == doctest::Approx(0.5031311702).epsilon(1e-6));
    CHECK(seen.map[5 * 9 + 8] == doctest::Approx(0.2784559750).epsilon(1e-6));
}

TEST_CASE("values that a screen cannot show are clamped") {
    CHECK(flip(grey(7.0F), grey(1.0F)).mean == 0.0);
    CHECK(flip(grey(-3.0F), grey(0.0F)).mean == 0.0);
}

TEST_CASE("pixels outside the mask are excluded from the mean") {
    Picture picture = grey(0.0F);
    picture.pixels[0] = glm::vec3(1.0F);
    const Flip all = flip(picture, grey(0.0F));
    Mask hit(picture.pixels.size(), 0);
    hit[0] = 1;
    const Flip one = flip(picture, grey(0.0F), hit);
    CHECK(one.map == all.map);
    CHECK(one.mean == all.map[0]);
    CHECK_THROWS_AS((void)flip(picture, noise({3, 3}, 1)), tools::ToolError);
}

TEST_CASE("light is compared as it is shown, with the exposure of the reference") {
    // All light times 2^k: another exposure, and the same difference.
    const Picture reference = noise(shape, 1), other = noise(shape, 2);
    const auto scaled = [](Picture picture, float factor) {
        for (glm::vec3& pixel : picture.pixels) pixel *= factor;
        return picture;
    };
    const double usual = tools::flip_of_light(other, reference).mean;
    CHECK(usual > 0.1);
    CHECK(tools::flip_of_light(scaled(other, 64.0F), scaled(reference, 64.0F)).mean ==
          doctest::Approx(usual).epsilon(1e-3));
    // A picture that is darker as a whole differs, as it is not exposed for itself.
    CHECK(tools::flip_of_light(scaled(reference, 0.25F), reference).mean > 0.1);
    CHECK(tools::flip_of_light(reference, reference).mean == 0.0);
    // A uniform picture is shown as the curve shows 18 % grey.
    const double grey_18 = (0.18 * (2.51 * 0.18 + 0.03)) / (0.18 * (2.43 * 0.18 + 0.59) + 0.14);
    const Picture shown = tools::displayed(grey(0.5F), tools::automatic_exposure(grey(0.5F)));
    CHECK(shown.pixels[3].g == doctest::Approx(grey_18).epsilon(1e-3));
    CHECK(tools::automatic_exposure(grey(0.0F)) == 1.0);
}

}  // TEST_SUITE("flip")

}  // namespace candela::study
