#include "tests/study/measures.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string_view>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace candela::study {
namespace {

using sandbox::Picture;

// A tenth of the mean brightness, squared; prevents dark pixels from dominating the relative error.
constexpr double floor_of_square = 0.01;

/// 0 divided by anything is 0, even by 0.
double ratio(double part, double whole) {
    return part == 0.0 ? 0.0 : part / whole;
}

double square(glm::dvec3 vector) {
    return glm::dot(vector, vector);
}

double channel_sum(glm::dvec3 vector) {
    return vector.r + vector.g + vector.b;
}

void require_finite(const Picture& picture, std::string_view name) {
    if (const auto pixel = first_not_finite(picture)) {
        throw std::invalid_argument(
            fmt::format("{}: pixel ({}, {}) is not finite", name, pixel->x, pixel->y));
    }
}

/// The mean of `value` over the pixels that count.
template <typename Value>
auto mean_over(std::size_t pixels, std::span<const std::uint8_t> hit, Value value) {
    decltype(value(std::size_t{0})) sum{};
    double count = 0.0;
    for (std::size_t i = 0; i < pixels; ++i) {
        if (!counts(hit, i)) continue;
        sum += value(i);
        count += 1.0;
    }
    return sum / count;
}

/// The mean RGB vector of the reference.
glm::dvec3 mean_vector(const Picture& picture, std::span<const std::uint8_t> hit) {
    return mean_over(picture.pixels.size(), hit,
                     [&](std::size_t i) { return glm::dvec3(picture.pixels[i]); });
}

double largest_channel(const Picture& picture, std::span<const std::uint8_t> hit) {
    double largest = 0.0;
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        if (counts(hit, i))
            largest =
                std::max<double>({largest, picture.pixels[i].r, picture.pixels[i].g, picture.pixels[i].b});
    }
    return largest;
}

/// The squared relative error of a pixel, or of a pixel's change: |a - r|² / (|r|² + 0.01 |m|²).
double relative_square(glm::dvec3 a, glm::dvec3 r, double mean_square) {
    return ratio(square(a - r), square(r) + floor_of_square * mean_square);
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

void require_sequences(std::span<const Picture> frames, std::span<const Picture> reference_frames,
                       std::span<const Mask> hits) {
    if (frames.size() < 2 || frames.size() != reference_frames.size() ||
        (!hits.empty() && hits.size() != frames.size())) {
        throw std::invalid_argument(fmt::format(
            "flicker is a measure of two frames or more, as many of the reference and a mask for each "
            "or none: not of {}, {} and {}",
            frames.size(), reference_frames.size(), hits.size()));
    }
    for (std::size_t i = 0; i < frames.size(); ++i) {
        require_comparable(frames[i], reference_frames[i], mask_of(hits, i));
        require_comparable(frames[i], frames[0], {});
    }
}

}  // namespace

std::optional<glm::ivec2> first_not_finite(const Picture& picture) {
    const auto found = std::find_if(picture.pixels.begin(), picture.pixels.end(), [](const glm::vec3& pixel) {
        return !(std::isfinite(pixel.r) && std::isfinite(pixel.g) && std::isfinite(pixel.b));
    });
    if (found == picture.pixels.end()) return std::nullopt;
    const auto index = static_cast<int>(found - picture.pixels.begin());
    return glm::ivec2(index % picture.size.x, index / picture.size.x);
}

void require_comparable(const Picture& picture, const Picture& reference, std::span<const std::uint8_t> hit) {
    if (picture.size != reference.size || picture.pixels.size() != reference.pixels.size()) {
        throw std::invalid_argument(fmt::format("a picture of {}x{} cannot be compared with one of {}x{}",
                                                picture.size.x, picture.size.y, reference.size.x,
                                                reference.size.y));
    }
    if (!hit.empty() && hit.size() != picture.pixels.size()) {
        throw std::invalid_argument(fmt::format("a mask of {} pixels does not fit {}x{}", hit.size(),
                                                picture.size.x, picture.size.y));
    }
    require_finite(picture, "the picture");
    require_finite(reference, "the reference");
    const bool any = hit.empty() ? !picture.pixels.empty()
                                 : std::any_of(hit.begin(), hit.end(), [](std::uint8_t h) { return h != 0; });
    if (!any) throw std::invalid_argument("no pixel counts");
}

Errors measure(const Picture& picture, const Picture& reference, std::span<const std::uint8_t> hit) {
    require_comparable(picture, reference, hit);
    const glm::dvec3 mean = mean_vector(reference, hit);
    const auto a = [&](std::size_t i) { return glm::dvec3(picture.pixels[i]); };
    const auto r = [&](std::size_t i) { return glm::dvec3(reference.pixels[i]); };
    const auto mean_of = [&](auto value) { return mean_over(picture.pixels.size(), hit, value); };
    return {
        .rel_mse = mean_of([&](std::size_t i) { return relative_square(a(i), r(i), square(mean)); }),
        .rmse = std::sqrt(mean_of([&](std::size_t i) { return square(a(i) - r(i)); })),
        .bias = ratio(mean_of([&](std::size_t i) { return channel_sum(a(i) - r(i)); }), channel_sum(mean)),
        .spikes = ratio(largest_channel(picture, hit), largest_channel(reference, hit)),
    };
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
                                     std::span<const Picture> reference_frames, std::span<const Mask> hits) {
    require_sequences(frames, reference_frames, hits);
    const auto count = static_cast<double>(frames.size());
    glm::dvec3 mean(0.0);
    for (std::size_t i = 0; i < frames.size(); ++i) {
        mean += mean_vector(reference_frames[i], mask_of(hits, i)) / count;
    }
    std::vector<double> pairs;
    pairs.reserve(frames.size() - 1);
    for (std::size_t next = 1; next < frames.size(); ++next) {
        const auto change = [next](std::span<const Picture> sequence, std::size_t pixel) {
            return glm::dvec3(sequence[next].pixels[pixel]) - glm::dvec3(sequence[next - 1].pixels[pixel]);
        };
        const Mask hit = both(mask_of(hits, next - 1), mask_of(hits, next));
        pairs.push_back(mean_over(frames[next].pixels.size(), hit, [&](std::size_t i) {
            return relative_square(change(frames, i), change(reference_frames, i), square(mean));
        }));
    }
    return pairs;
}

double flicker(std::span<const Picture> frames, std::span<const Picture> reference_frames,
               std::span<const Mask> hits) {
    const std::vector<double> pairs = flicker_of_pairs(frames, reference_frames, hits);
    return std::accumulate(pairs.begin(), pairs.end(), 0.0) / static_cast<double>(pairs.size());
}

Picture scaled_down(const Picture& picture, int factor) {
    const glm::ivec2 size = picture.size / factor;
    const auto share = 1.0F / static_cast<float>(factor * factor);
    const auto index = [](glm::ivec2 of, int x, int y) { return static_cast<std::size_t>(y * of.x + x); };
    Picture small{size, std::vector<glm::vec3>(index(size, 0, size.y))};
    for (int y = 0; y < size.y * factor; ++y) {
        for (int x = 0; x < size.x * factor; ++x) {
            small.pixels[index(size, x / factor, y / factor)] +=
                share * picture.pixels[index(picture.size, x, y)];
        }
    }
    return small;
}

}  // namespace candela::study
