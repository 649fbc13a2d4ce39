#include "tests/study/measures.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace candela::study {
namespace {

using tools::mean_over;
using tools::mean_vector;
using tools::Picture;
using tools::ratio;
using tools::relative_square;
using tools::square;

double channel_sum(glm::dvec3 vector) {
    return vector.r + vector.g + vector.b;
}

double largest_channel(const Picture& picture, std::span<const std::uint8_t> hit) {
    double largest = 0.0;
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        if (counts(hit, i)) {
            largest =
                std::max<double>({largest, picture.pixels[i].r, picture.pixels[i].g, picture.pixels[i].b});
        }
    }
    return largest;
}

/// The mask of a frame; empty if all pixels count.
std::span<const std::uint8_t> mask_of(std::span<const Mask> hits, std::size_t frame) {
    return hits.empty() ? std::span<const std::uint8_t>() : std::span(hits[frame]);
}

/// The pixels that count in both frames.
Mask both(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b) {
    Mask mask(a.size());
    std::transform(a.begin(), a.end(), b.begin(), mask.begin(), [](std::uint8_t x, std::uint8_t y) {
        return static_cast<std::uint8_t>(x != 0 && y != 0 ? 1 : 0);
    });
    if (!mask.empty() && std::all_of(mask.begin(), mask.end(), [](std::uint8_t h) { return h == 0; })) {
        throw std::invalid_argument("no pixel counts in two consecutive frames");
    }
    return mask;
}

void require_sequences(std::span<const Picture> frames, std::span<const Halves> reference_frames,
                       std::span<const Mask> hits) {
    if (frames.size() < 2 || frames.size() != reference_frames.size() ||
        (!hits.empty() && hits.size() != frames.size())) {
        throw std::invalid_argument(fmt::format(
            "flicker is a measure of two frames or more, as many of the reference and a mask for each "
            "or none: not of {}, {} and {}",
            frames.size(), reference_frames.size(), hits.size()));
    }
    for (std::size_t i = 0; i < frames.size(); ++i) {
        for (const Picture& half : reference_frames[i]) require_comparable(frames[i], half, mask_of(hits, i));
        require_comparable(frames[i], frames[0], {});
    }
}

}  // namespace

Errors measure(const Picture& picture, const Picture& reference, std::span<const std::uint8_t> hit) {
    return measure(picture, Halves{reference, reference}, hit);
}

Errors measure(const Picture& picture, const Halves& reference, std::span<const std::uint8_t> hit) {
    const double rel_mse = tools::relative_mse(picture, reference, hit);
    const Picture mean = mean_of(reference);
    const double product = mean_over(picture.pixels.size(), hit, [&](std::size_t i) {
        const glm::dvec3 a(picture.pixels[i]);
        return glm::dot(a - glm::dvec3(reference[0].pixels[i]), a - glm::dvec3(reference[1].pixels[i]));
    });
    const double expected = channel_sum(mean_vector(mean, hit));
    return {
        .rel_mse = rel_mse,
        .rmse = std::sqrt(std::max(product, 0.0)),
        .bias = ratio(channel_sum(mean_vector(picture, hit)) - expected, expected),
        .spikes = ratio(largest_channel(picture, hit), largest_channel(mean, hit)),
        .blotch = tools::blotch(picture, reference, hit),
    };
}

Picture mean_of(const Halves& halves) {
    Picture mean = halves[0];
    for (std::size_t i = 0; i < mean.pixels.size(); ++i) {
        mean.pixels[i] = 0.5F * (halves[0].pixels[i] + halves[1].pixels[i]);
    }
    return mean;
}

std::vector<double> relative_errors(const Picture& picture, const Picture& reference,
                                    std::span<const std::uint8_t> hit) {
    require_comparable(picture, reference, hit);
    const double mean_square = square(mean_vector(reference, hit));
    std::vector<double> errors(picture.pixels.size());
    for (std::size_t i = 0; i < errors.size(); ++i) {
        if (!counts(hit, i)) continue;
        errors[i] = std::sqrt(relative_square(picture.pixels[i], reference.pixels[i], mean_square));
    }
    return errors;
}

std::vector<double> flicker_of_pairs(std::span<const Picture> frames,
                                     std::span<const Halves> reference_frames, std::span<const Mask> hits) {
    require_sequences(frames, reference_frames, hits);
    const auto count = static_cast<double>(frames.size());
    glm::dvec3 mean(0.0);
    for (std::size_t i = 0; i < frames.size(); ++i) {
        mean += mean_vector(mean_of(reference_frames[i]), mask_of(hits, i)) / count;
    }
    std::vector<double> pairs;
    pairs.reserve(frames.size() - 1);
    for (std::size_t next = 1; next < frames.size(); ++next) {
        const Mask hit = both(mask_of(hits, next - 1), mask_of(hits, next));
        const Halves& before = reference_frames[next - 1];
        const Halves& now = reference_frames[next];
        pairs.push_back(mean_over(frames[next].pixels.size(), hit, [&](std::size_t i) {
            const auto change = [i](const Picture& a, const Picture& b) {
                return glm::dvec3(b.pixels[i]) - glm::dvec3(a.pixels[i]);
            };
            return tools::relative_product(change(frames[next - 1], frames[next]), change(before[0], now[0]),
                                           change(before[1], now[1]), square(mean));
        }));
    }
    return pairs;
}

double flicker(std::span<const Picture> frames, std::span<const Halves> reference_frames,
               std::span<const Mask> hits) {
    const std::vector<double> pairs = flicker_of_pairs(frames, reference_frames, hits);
    return std::accumulate(pairs.begin(), pairs.end(), 0.0) / static_cast<double>(pairs.size());
}

std::optional<double> rel_mse_of_blocks(const Picture& picture, const Halves& reference, const Mask& hit) {
    for (const Picture& half : reference) require_comparable(picture, half, {});
    constexpr int side = 6;
    const tools::Blocks blocks = tools::blocks_of(picture, hit, side);
    if (std::ranges::count(blocks.hit, 1) == 0) return std::nullopt;
    const auto means = [&](const Picture& half) { return tools::blocks_of(half, hit, side).means; };
    return tools::relative_mse(blocks.means, {means(reference[0]), means(reference[1])}, blocks.hit);
}

Picture scaled_down(const Picture& picture, int factor) {
    return tools::blocks_of(picture, {}, factor).means;
}

}  // namespace candela::study
