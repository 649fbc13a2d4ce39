#include "sandbox/window/noise_estimate.hpp"

#include <cmath>
#include <cstddef>
#include <utility>

namespace candela::sandbox {

namespace {

/// The root of the mean square of a - b, over the mean of b; of all pixels and channels that are finite in
/// both.
double relative_distance(const std::vector<glm::vec4>& a, const std::vector<glm::vec4>& b) {
    double squares = 0.0;
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        for (glm::length_t channel = 0; channel < 3; ++channel) {
            const auto first = static_cast<double>(a[i][channel]);
            const auto second = static_cast<double>(b[i][channel]);
            if (!std::isfinite(first) || !std::isfinite(second)) continue;
            squares += (first - second) * (first - second);
            sum += second;
            count += 1.0;
        }
    }
    return sum > 0.0 ? std::sqrt(squares * count) / sum : 0.0;
}

}  // namespace

bool NoiseEstimate::wants(std::uint32_t frames) const {
    constexpr std::uint32_t least = 16;
    if (frames < newest_) return true;
    return frames >= least && 2 * std::uint64_t{frames} >= 3 * std::uint64_t{newest_};
}

void NoiseEstimate::add(std::uint32_t frames, std::vector<glm::vec4> mean) {
    if (frames < newest_ || mean.size() != mean_.size()) reset();
    newest_ = frames;
    if (frames_ > 0 && frames > frames_) {
        // With s the deviation of a single frame, and a and b the two numbers of frames, the two means are
        // s·sqrt(1/a - 1/b) apart, because the mean of b has the first a frames in it; that of b deviates by
        // s/sqrt(b).
        const double a = frames_;
        const double b = frames;
        value_ = relative_distance(mean_, mean) * std::sqrt(a / (b - a));
    }
    if (frames >= 2 * frames_) {
        frames_ = frames;
        mean_ = std::move(mean);
    }
}

}  // namespace candela::sandbox
