#include "sandbox/window/noise_estimate.hpp"

#include <cmath>
#include <random>

#include <doctest/doctest.h>

namespace candela::sandbox {

TEST_SUITE("noise estimate") {

namespace {

constexpr std::size_t pixels = 20000;

/// The mean of more and more frames whose pixels are normally distributed.
class Refined {
 public:
    /// `deviation` is relative to the pixels' mean.
    explicit Refined(float deviation) : deviation_(deviation) {}

    std::vector<glm::vec4> frame() {
        ++frames_;
        std::normal_distribution<float> noise(1.0F, deviation_);
        std::vector<glm::vec4> mean(pixels);
        for (std::size_t i = 0; i < pixels; ++i) {
            for (glm::length_t channel = 0; channel < 3; ++channel) sums_[i][channel] += noise(random_);
            mean[i] = sums_[i] / static_cast<float>(frames_);
        }
        return mean;
    }
    [[nodiscard]] std::uint32_t frames() const { return frames_; }

 private:
    float deviation_;
    std::uint32_t frames_ = 0;
    std::mt19937 random_{5};
    std::vector<glm::vec4> sums_{pixels, glm::vec4(0.0F)};
};

}  // namespace

TEST_CASE(
    "it is the deviation of the mean of independent frames, which falls with the root of their number") {
    Refined refined(0.2F);
    NoiseEstimate noise;
    int values = 0;
    while (refined.frames() < 100) {
        std::vector<glm::vec4> mean = refined.frame();
        if (!noise.wants(refined.frames())) continue;
        noise.add(refined.frames(), std::move(mean));
        if (!noise.value()) continue;
        ++values;
        const double expected = 0.2 / std::sqrt(refined.frames());
        // 60,000 samples: the estimate deviates by 1 / sqrt(120,000), 0.3 %, and somewhat more as its parts
        // are not independent.
        CHECK(std::abs(*noise.value() / expected - 1.0) < 0.015);
    }
    CHECK(values >= 4);
    CHECK(values <= 8);  // reading pictures back takes time
}

TEST_CASE("frames may depend on each other within small groups") {
    constexpr std::uint32_t group = 8;
    Refined refined(0.2F);
    NoiseEstimate noise;
    for (std::uint32_t frames = group; frames <= 20 * group; frames += group) {
        std::vector<glm::vec4> mean = refined.frame();  // of one more group
        if (!noise.wants(frames)) continue;
        noise.add(frames, std::move(mean));
        if (!noise.value()) continue;
        const double expected = 0.2 / std::sqrt(refined.frames());
        CHECK(std::abs(*noise.value() / expected - 1.0) < 0.015);
    }
    CHECK(noise.value());
}

TEST_CASE("it begins anew with another picture") {
    NoiseEstimate noise;
    CHECK_FALSE(noise.wants(1));
    CHECK(noise.wants(16));
    noise.add(16, {glm::vec4(1.0F)});
    CHECK_FALSE(noise.value());
    CHECK_FALSE(noise.wants(20));
    noise.add(32, {glm::vec4(1.0F)});
    CHECK(noise.value() == 0.0);
    // Fewer frames are those of another picture, as are other pixels.
    CHECK(noise.wants(2));
    noise.add(16, {glm::vec4(2.0F)});
    CHECK_FALSE(noise.value());
    noise.add(32, {glm::vec4(2.0F)});
    CHECK(noise.value());
    noise.add(64, {glm::vec4(2.0F), glm::vec4(2.0F)});
    CHECK_FALSE(noise.value());
}

TEST_CASE("black pictures have no noise, and values that are no numbers do not count") {
    NoiseEstimate noise;
    noise.add(4, {glm::vec4(0.0F), glm::vec4(0.0F)});
    noise.add(8, {glm::vec4(0.0F), glm::vec4(NAN)});
    CHECK(noise.value() == 0.0);
}
}  // TEST_SUITE("noise estimate")

}  // namespace candela::sandbox
