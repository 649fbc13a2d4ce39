#include "tests/study/measures.hpp"

#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>

#include <doctest/doctest.h>

#include <candela/tools/tool_error.hpp>
#include "tests/study/test_pictures.hpp"

namespace candela::study {

using tools::Picture;

namespace {

// Radiance is stored as floats with a relative rounding error of 6e-8, which squaring doubles.
doctest::Approx about(double value) {
    return doctest::Approx(value).epsilon(1e-6);
}

/// A picture of one row.
Picture row(std::vector<glm::vec3> pixels) {
    return {{static_cast<int>(pixels.size()), 1}, std::move(pixels)};
}

Picture scaled(Picture picture, float factor) {
    for (glm::vec3& pixel : picture.pixels) pixel *= factor;
    return picture;
}

}  // namespace

TEST_SUITE("measures") {
TEST_CASE("a picture has no error against itself") {
    const Picture picture = noise({13, 7}, 1);
    const Errors errors = measure(picture, picture);
    CHECK(errors.rel_mse == 0.0);
    CHECK(errors.rmse == 0.0);
    CHECK(errors.bias == 0.0);
    CHECK(errors.spikes == 1.0);
}

TEST_CASE("all measures of a constant offset equal their closed forms") {
    // |a - r|² = 3 · 0.5², |r|² = |m|² = 3 · 2².
    const Errors errors = measure(constant({8, 5}, glm::vec3(2.5F)), constant({8, 5}, glm::vec3(2.0F)));
    CHECK(errors.rel_mse == about(0.25 / (4.0 * 1.01)));
    CHECK(errors.rmse == about(0.5 * std::sqrt(3.0)));
    CHECK(errors.bias == about(0.25));
    CHECK(errors.spikes == about(1.25));
}

TEST_CASE("the channels of a pixel are measured as one vector") {
    // |a - r|² = 2² + 1², |r|² = |m|² = 1 + 4 + 16; Σ(a - r) = 1 of Σr = 7; the largest channels are 4
    // and 5.
    const Errors errors = measure(row({{1.0F, 0.0F, 4.0F + 1.0F}}), row({{1.0F, 2.0F, 4.0F}}));
    CHECK(errors.rel_mse == about(5.0 / (21.0 * 1.01)));
    CHECK(errors.rmse == about(std::sqrt(5.0)));
    CHECK(errors.bias == about(-1.0 / 7.0));
    CHECK(errors.spikes == about(5.0 / 4.0));
}

TEST_CASE("the floor uses the length of the mean colour, not the mean of lengths") {
    // r is red in one pixel and green in the other, so m = (1, 1, 0) / 2 and |m|² = 1/2, not 1 as a mean
    // of lengths would give. Each pixel lacks all of its light.
    const Errors errors =
        measure(row({{0.0F, 0.0F, 0.0F}, {0.0F, 0.0F, 0.0F}}), row({{1.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F}}));
    CHECK(errors.rel_mse == about(1.0 / (1.0 + 0.01 * 0.5)));
    CHECK(errors.bias == about(-1.0));
    CHECK(errors.spikes == 0.0);
}

TEST_CASE("the error of a black pixel is divided by the floor alone") {
    // m = (1, 1, 1). The second pixel is black where the picture shows 0.1: 0.03 / 0.03.
    const Errors errors =
        measure(row({glm::vec3(2.0F), glm::vec3(0.1F)}), row({glm::vec3(2.0F), glm::vec3(0.0F)}));
    CHECK(errors.rel_mse == about(0.5));
    CHECK(errors.bias == about(0.05));
}

TEST_CASE("relMSE, bias and spikes do not depend on the unit of radiance, RMSE does") {
    const Picture picture = noise({16, 16}, 1);
    const Picture reference = noise({16, 16}, 2);
    const Errors errors = measure(picture, reference);
    // A power of two, so that scaling is exact.
    const Errors bright = measure(scaled(picture, 1024.0F), scaled(reference, 1024.0F));
    CHECK(bright.rel_mse == doctest::Approx(errors.rel_mse).epsilon(1e-12));
    CHECK(bright.rmse == doctest::Approx(1024.0 * errors.rmse).epsilon(1e-12));
    CHECK(bright.bias == doctest::Approx(errors.bias).epsilon(1e-12));
    CHECK(bright.spikes == errors.spikes);
}

TEST_CASE("the bias of a scaled picture follows from its scale") {
    const Picture reference = noise({16, 16}, 3);
    const Errors errors = measure(scaled(reference, 0.75F), reference);
    CHECK(errors.bias == about(-0.25));
    CHECK(errors.spikes == about(0.75));
    // Every pixel lacks a quarter of its light; the floor only lowers the quotient.
    CHECK(errors.rel_mse < 0.0625);
    CHECK(errors.rel_mse > 0.05);
}

TEST_CASE("one spike among many pixels") {
    constexpr double pixels = 100.0;
    const Picture reference = constant({10, 10}, glm::vec3(1.0F));
    Picture picture = reference;
    picture.pixels[37] = glm::vec3(11.0F);
    const Errors errors = measure(picture, reference);
    CHECK(errors.rel_mse == about(100.0 / 1.01 / pixels));
    CHECK(errors.rmse == about(std::sqrt(300.0 / pixels)));
    CHECK(errors.bias == about(10.0 / pixels));
    CHECK(errors.spikes == about(11.0));
}

TEST_CASE("pixels outside the mask do not count, not even in the mean") {
    Picture picture = row({glm::vec3(2.5F), glm::vec3(1e6F), glm::vec3(2.5F)});
    Picture reference = row({glm::vec3(2.0F), glm::vec3(-1e6F), glm::vec3(2.0F)});
    const Mask hit{1, 0, 255};
    const Errors errors = measure(picture, reference, hit);
    CHECK(errors.rel_mse == about(0.25 / (4.0 * 1.01)));
    CHECK(errors.rmse == about(0.5 * std::sqrt(3.0)));
    CHECK(errors.bias == about(0.25));
    CHECK(errors.spikes == about(1.25));
    CHECK(relative_errors(picture, reference, hit)[1] == 0.0);
}

TEST_CASE("blocks are measured by the means of their pixels that count, if these are half of them") {
    // Left: pixels in turn 1 and 3, of which the mean is right. Right: 2 in the few pixels that count.
    const glm::ivec2 size{12, 6};
    Picture picture = constant(size, glm::vec3(9.0F));
    Mask hit(72, 1);
    for (int i = 0; i < 72; ++i) {
        const int x = i % 12;
        const auto pixel = static_cast<std::size_t>(i);
        if (x < 6) picture.pixels[pixel] = glm::vec3(x % 2 == 0 ? 1.0F : 3.0F);
        hit[pixel] = x < 6 || x >= 10 ? 1 : 0;
    }
    const Picture reference = constant(size, glm::vec3(2.0F));
    const Halves halves{reference, reference};
    CHECK(rel_mse_of_blocks(picture, halves, hit).value() == about(0.0));
    // With one more column, the block on the right counts: 9 instead of 2, in one of two blocks.
    for (std::size_t row = 0; row < 6; ++row) hit[12 * row + 9] = 1;
    CHECK(rel_mse_of_blocks(picture, halves, hit).value() == about(0.5 * 49.0 / (4.0 * 1.01)));
    CHECK_FALSE(rel_mse_of_blocks(picture, halves, Mask(72, 0)));
}

TEST_CASE("a blotch is what a blur leaves of the error, by the pixels that count") {
    const glm::ivec2 size{120, 40};  // a blur of one pixel
    const Picture reference = constant(size, glm::vec3(1.0F));
    const auto measured = [&](auto value, std::span<const std::uint8_t> hit = {}) {
        Picture picture = reference;
        for (int i = 0; i < size.x * size.y; ++i) {
            picture.pixels[static_cast<std::size_t>(i)] = glm::vec3(value(i % size.x, i / size.x));
        }
        return measure(picture, reference, hit);
    };
    const auto even = [](int, int) { return 1.5F; };
    CHECK(measured(even).blotch == about(0.25 / 1.01));
    const Errors fine = measured([](int x, int y) { return (x + y) % 2 == 0 ? 1.5F : 0.5F; });
    CHECK(fine.rel_mse == about(0.25 / 1.01));
    // A blur of one pixel leaves exp(-π²) of a chequerboard; less than a tenth at the picture's edge.
    CHECK(fine.blotch < 1e-3 * fine.rel_mse);
    const Errors coarse = measured([](int x, int) { return x < 60 ? 1.5F : 0.5F; });
    // All but what is within two pixels of the step.
    CHECK(coarse.blotch > 0.95 * coarse.rel_mse);
    CHECK(coarse.blotch < coarse.rel_mse);
    Mask left(reference.pixels.size());
    for (std::size_t i = 0; i < left.size(); ++i) left[i] = i % 120 < 60 ? 1 : 0;
    CHECK(measured([](int x, int) { return x < 60 ? 1.5F : 9.0F; }, left).blotch == about(0.25 / 1.01));
}

TEST_CASE("noise of a reference's halves is no error") {
    // The picture is 0.1 too bright; the halves have noise with a variance of 0.2² / 12.
    const glm::ivec2 size{240, 160};
    const Picture picture = constant(size, glm::vec3(2.6F));
    Halves halves{noise(size, 1), noise(size, 2)};
    for (Picture& half : halves) {
        for (glm::vec3& pixel : half.pixels) pixel = 2.4F + 0.2F * pixel;
    }
    const double square = 2.5 * 2.5 * 1.01;
    const double expected = 0.1 * 0.1 / square;
    const Errors errors = measure(picture, halves);
    // (0.1 - noise) (0.1 - noise') has a standard deviation of 0.009, its mean over 240 · 160 · 3 of 0.00003:
    // four of them.
    const double rounding = 4.0 * 0.00003 / square;
    CHECK(errors.rel_mse == doctest::Approx(expected).epsilon(rounding));
    CHECK(errors.blotch == doctest::Approx(expected).epsilon(rounding));
    CHECK(errors.rmse == doctest::Approx(0.1 * std::sqrt(3.0)).epsilon(0.001));
    CHECK(errors.bias == doctest::Approx(0.04).epsilon(0.0001));
    // Against the mean of the halves, half of the variance of their noise is added.
    const double noise_of_mean = 0.5 * 0.2 * 0.2 / 12.0 / square;
    CHECK(measure(picture, mean_of(halves)).rel_mse ==
          doctest::Approx(expected + noise_of_mean).epsilon(2.0 * rounding));
}

TEST_CASE("the mean square of the relative errors is the relMSE") {
    const Picture picture = noise({9, 11}, 4);
    const Picture reference = noise({9, 11}, 5);
    double sum = 0.0;
    for (const double error : relative_errors(picture, reference)) sum += error * error;
    CHECK(sum / 99.0 == doctest::Approx(measure(picture, reference).rel_mse).epsilon(1e-12));
}

TEST_CASE("with a black reference, a black picture has no error, others an infinite relative error") {
    const Picture black = constant({2, 2}, glm::vec3(0.0F));
    const Errors right = measure(black, black);
    CHECK(right.rel_mse == 0.0);
    CHECK(right.bias == 0.0);
    CHECK(right.spikes == 0.0);
    const Errors wrong = measure(constant({2, 2}, glm::vec3(1.0F)), black);
    CHECK(std::isinf(wrong.rel_mse));
    CHECK(std::isinf(wrong.bias));
    CHECK(std::isinf(wrong.spikes));
    CHECK(wrong.rmse == about(std::sqrt(3.0)));
}

TEST_CASE("pictures that cannot be compared are refused") {
    const Picture picture = constant({4, 3}, glm::vec3(1.0F));
    CHECK_THROWS_WITH_AS((void)measure(picture, constant({3, 4}, glm::vec3(1.0F))),
                         "a picture of 4x3 cannot be compared with one of 3x4", tools::ToolError);
    CHECK_THROWS_WITH_AS((void)measure(picture, picture, Mask(11, 1)), "a mask of 11 pixels does not fit 4x3",
                         tools::ToolError);
    CHECK_THROWS_WITH_AS((void)measure(picture, picture, Mask(12, 0)), "no pixel counts", tools::ToolError);
    CHECK_THROWS_WITH_AS((void)measure(Picture(), Picture()), "no pixel counts", tools::ToolError);
    for (const float value :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        Picture bad = picture;
        bad.pixels[6].g = value;
        CHECK(first_not_finite(bad) == glm::ivec2(2, 1));
        CHECK_THROWS_WITH_AS((void)measure(bad, picture), "the picture: pixel (2, 1) is not finite",
                             tools::ToolError);
        CHECK_THROWS_WITH_AS((void)measure(picture, bad), "the reference: pixel (2, 1) is not finite",
                             tools::ToolError);
    }
    CHECK(first_not_finite(picture) == std::nullopt);
}

}  // TEST_SUITE("measures")

TEST_SUITE("flicker") {

namespace {

/// Frames without noise.
std::vector<Halves> exact(const std::vector<Picture>& frames) {
    std::vector<Halves> halves;
    for (const Picture& frame : frames) halves.push_back({frame, frame});
    return halves;
}

}  // namespace

TEST_CASE("a constant error does not flicker, whatever moves") {
    // Sums of quarters, which floats hold exactly.
    std::vector<Picture> frames;
    std::vector<Picture> reference;
    for (const float light : {1.0F, 1.5F, 0.25F, 2.0F}) {
        reference.push_back(row({glm::vec3(light), glm::vec3(2.0F * light)}));
        frames.push_back(row({glm::vec3(light + 0.5F), glm::vec3(2.0F * light - 0.25F)}));
    }
    CHECK(flicker(frames, exact(reference)) == 0.0);
    CHECK(measure(frames[0], reference[0]).rel_mse > 0.01);
}

TEST_CASE("an error that changes its sign from frame to frame flickers by twice its size") {
    // Nothing moves in the reference: |Δa - Δr|² = |2e|², |Δr|² = 0, |m|² = |r|².
    std::vector<Picture> frames;
    const std::vector<Picture> reference(5, constant({3, 3}, glm::vec3(2.0F)));
    for (const float error : {0.125F, -0.125F, 0.125F, -0.125F, 0.125F}) {
        frames.push_back(constant({3, 3}, glm::vec3(2.0F + error)));
    }
    CHECK(flicker(frames, exact(reference)) == about(0.25 * 0.25 / (0.01 * 4.0)));
}

TEST_CASE("each pair of frames has its own flicker, and the flicker of all is their mean") {
    // As above: |Δa|² = 3 · 1 and 0, each over 0.01 · 3 · 2².
    const std::vector<Picture> reference(3, constant({2, 2}, glm::vec3(2.0F)));
    const std::vector<Picture> frames{constant({2, 2}, glm::vec3(2.0F)), constant({2, 2}, glm::vec3(3.0F)),
                                      constant({2, 2}, glm::vec3(3.0F))};
    const std::vector<double> pairs = flicker_of_pairs(frames, exact(reference));
    REQUIRE(pairs.size() == 2);
    CHECK(pairs[0] == about(1.0 / 0.04));
    CHECK(pairs[1] == 0.0);
    CHECK(flicker(frames, exact(reference)) == about(0.5 / 0.04));
}

TEST_CASE("flicker is relative to the changes of the reference") {
    // Δr = 2 in each channel, Δa = 1; m = 2: 1 / (4 + 0.04).
    const std::vector<Picture> reference{constant({2, 2}, glm::vec3(1.0F)),
                                         constant({2, 2}, glm::vec3(3.0F))};
    const std::vector<Picture> frames{constant({2, 2}, glm::vec3(1.0F)), constant({2, 2}, glm::vec3(2.0F))};
    CHECK(flicker(frames, exact(reference)) == about(1.0 / 4.04));
    // A picture that does not move lacks all of the change.
    const std::vector<Picture> still(2, constant({2, 2}, glm::vec3(7.0F)));
    CHECK(flicker(still, exact(reference)) == about(4.0 / 4.04));
}

TEST_CASE("noise of the reference does not flicker") {
    // A still picture before a still reference, whose halves have noise of a variance of 0.05² / 12.
    const glm::ivec2 size{240, 160};
    const std::vector<Picture> still(2, constant(size, glm::vec3(2.5F)));
    std::vector<Halves> reference;
    for (const std::uint32_t seed : {1U, 3U}) {
        Halves& halves = reference.emplace_back(Halves{noise(size, seed), noise(size, seed + 1)});
        for (Picture& half : halves) {
            for (glm::vec3& pixel : half.pixels) pixel = 2.475F + 0.05F * pixel;
        }
    }
    // Products of differences of noise have a standard deviation of 2 · 0.05² / 12 = 0.00042 in a channel,
    // their mean over 240 · 160 · 3 one of 0.0000012: four of them, relative to 0.01 · 2.5².
    CHECK(std::abs(flicker(still, reference)) < 4.0 * 0.0000012 / 0.0625);
    // One half alone has all of its noise: 2 · 0.05² / 12.
    CHECK(flicker(still, exact({reference[0][0], reference[1][0]})) ==
          doctest::Approx(0.00042 / 0.0625).epsilon(0.0003));
}

TEST_CASE("only pixels that count in both frames are compared") {
    const std::vector<Picture> reference(2, row({glm::vec3(1.0F), glm::vec3(1.0F), glm::vec3(1.0F)}));
    const std::vector<Picture> frames{reference[0],
                                      row({glm::vec3(1.5F), glm::vec3(9.0F), glm::vec3(-9.0F)})};
    const std::vector<Mask> hits{{1, 1, 0}, {1, 0, 1}};
    CHECK(flicker(frames, exact(reference), hits) == about(0.25 / 0.01));
    const std::vector<Mask> apart{{1, 0, 0}, {0, 1, 1}};
    CHECK_THROWS_WITH_AS((void)flicker(frames, exact(reference), apart),
                         "no pixel counts in two consecutive frames", std::invalid_argument);
}

TEST_CASE("sequences that do not fit are refused") {
    const std::vector<Picture> two(2, constant({2, 2}, glm::vec3(1.0F)));
    const std::vector<Picture> one(1, two[0]);
    const std::vector<Mask> mask(1, Mask(4, 1));
    CHECK_THROWS_AS((void)flicker(one, exact(one)), std::invalid_argument);
    CHECK_THROWS_AS((void)flicker(two, exact(one)), std::invalid_argument);
    CHECK_THROWS_AS((void)flicker(two, exact(two), mask), std::invalid_argument);
    std::vector<Picture> grown = two;
    grown[1] = constant({3, 2}, glm::vec3(1.0F));
    CHECK_THROWS_AS((void)flicker(two, exact(grown)), tools::ToolError);
    CHECK_THROWS_AS((void)flicker(grown, exact(grown)), tools::ToolError);
}

}  // TEST_SUITE("flicker")

}  // namespace candela::study
