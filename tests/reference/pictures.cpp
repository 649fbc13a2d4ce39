#include "tests/reference/pictures.hpp"

#include <algorithm>
#include <cmath>

namespace candela::reference {

namespace {

double red(const tools::Picture& picture, std::size_t pixel) {
    return static_cast<double>(picture.pixels[pixel].r);
}

/// The error of the mean of both halves, estimated from their difference.
double error_of_mean(const Estimate& estimate, std::size_t pixel) {
    return 0.5 * (red(estimate.halves[0], pixel) - red(estimate.halves[1], pixel));
}

}  // namespace

tools::Picture flipped(const candela::Picture& picture) {
    tools::Picture flipped{glm::ivec2(picture.size), {}};
    for (std::uint32_t y = picture.size.y; y-- > 0;) {
        for (std::uint32_t x = 0; x < picture.size.x; ++x) flipped.pixels.push_back(picture.at(x, y));
    }
    return flipped;
}

std::vector<std::uint8_t> without(const std::vector<std::uint8_t>& mask,
                                  const std::vector<std::uint8_t>& removed) {
    std::vector<std::uint8_t> rest(mask.size());
    for (std::size_t i = 0; i < mask.size(); ++i) rest[i] = mask[i] != 0 && removed[i] == 0 ? 1 : 0;
    return rest;
}

NoisyMean mean_indirect(const Estimate& estimate, const std::vector<std::uint8_t>& mask) {
    double sum = 0.0;
    double variance = 0.0;
    double count = 0.0;
    for (std::size_t i = 0; i < mask.size(); ++i) {
        if (mask[i] == 0) continue;
        sum += red(estimate.indirect, i);
        variance += std::pow(error_of_mean(estimate, i), 2.0);
        count += 1.0;
    }
    return {sum / count, std::sqrt(variance) / count};
}

double noise_ratio(const Estimate& estimate, const tools::Picture& truth,
                   const std::vector<std::uint8_t>& mask) {
    double actual = 0.0;
    double estimated = 0.0;
    for (std::size_t i = 0; i < mask.size(); ++i) {
        if (mask[i] == 0) continue;
        actual += std::pow(red(estimate.indirect, i) - red(truth, i), 2.0);
        estimated += std::pow(error_of_mean(estimate, i), 2.0);
    }
    return actual / estimated;
}

double worst_error(const tools::Picture& a, const tools::Picture& b, const std::vector<std::uint8_t>& mask,
                   double floor) {
    double worst = 0.0;
    for (std::size_t i = 0; i < mask.size(); ++i) {
        if (mask[i] == 0) continue;
        worst = std::max(worst, std::abs(red(a, i) - red(b, i)) / std::max(red(b, i), floor));
    }
    return worst;
}

}  // namespace candela::reference
