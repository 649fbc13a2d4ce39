#include <candela/tools/picture_error.hpp>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include <candela/tools/tool_error.hpp>

namespace candela::tools {

namespace {

// A tenth of the mean brightness, squared; prevents dark pixels from dominating the relative error.
constexpr double floor_of_square = 0.01;

void require_finite(const Picture& picture, std::string_view name) {
    if (const auto pixel = first_not_finite(picture)) {
        throw ToolError(fmt::format("{}: pixel ({}, {}) is not finite", name, pixel->x, pixel->y));
    }
}

std::size_t index_of(glm::ivec2 pixel, glm::ivec2 size) {
    return static_cast<std::size_t>(pixel.y) * static_cast<std::size_t>(size.x) +
           static_cast<std::size_t>(pixel.x);
}

/// Sums along one axis of the pixels that count, and of their weights (alpha).
std::vector<glm::dvec4> blurred_along(const std::vector<glm::dvec4>& pixels, glm::ivec2 size, glm::ivec2 axis,
                                      double deviation) {
    const int reach = static_cast<int>(std::ceil(3.0 * deviation));
    std::vector<glm::dvec4> sums(pixels.size(), glm::dvec4(0.0));
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            glm::dvec4& sum = sums[index_of({x, y}, size)];
            for (int k = -reach; k <= reach; ++k) {
                const glm::ivec2 at = glm::ivec2(x, y) + k * axis;
                if (at.x < 0 || at.y < 0 || at.x >= size.x || at.y >= size.y) continue;
                const double weight = std::exp(-0.5 * k * k / (deviation * deviation));
                sum += weight * pixels[index_of(at, size)];
            }
        }
    }
    return sums;
}

/// mean((a - p) · (a - q) / (|r|² + 0.01 |m|²)), r being the mean of p and q.
double relative_mean(const Picture& a, const Picture& p, const Picture& q,
                     std::span<const std::uint8_t> hit) {
    const double mean_square = square(0.5 * (mean_vector(p, hit) + mean_vector(q, hit)));
    return mean_over(a.pixels.size(), hit, [&](std::size_t i) {
        return relative_product(a.pixels[i], p.pixels[i], q.pixels[i], mean_square);
    });
}

Picture blurred(const Picture& picture, std::span<const std::uint8_t> hit) {
    const double deviation = picture.size.x / 120.0;
    std::vector<glm::dvec4> pixels;
    pixels.reserve(picture.pixels.size());
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        pixels.push_back(counts(hit, i) ? glm::dvec4(picture.pixels[i], 1.0) : glm::dvec4(0.0));
    }
    pixels = blurred_along(pixels, picture.size, {1, 0}, deviation);
    pixels = blurred_along(pixels, picture.size, {0, 1}, deviation);
    Picture result{picture.size, {}};
    for (const glm::dvec4& sum : pixels) result.pixels.emplace_back(glm::dvec3(sum) / std::max(sum.a, 1e-30));
    return result;
}

}  // namespace

double relative_mse(const Picture& picture, const Picture& reference, std::span<const std::uint8_t> hit) {
    require_comparable(picture, reference, hit);
    return relative_mean(picture, reference, reference, hit);
}

double relative_mse(const Picture& picture, const Halves& reference, std::span<const std::uint8_t> hit) {
    for (const Picture& half : reference) require_comparable(picture, half, hit);
    return relative_mean(picture, reference[0], reference[1], hit);
}

double blotch(const Picture& picture, const Picture& reference, std::span<const std::uint8_t> hit) {
    require_comparable(picture, reference, hit);
    return relative_mse(blurred(picture, hit), blurred(reference, hit), hit);
}

double blotch(const Picture& picture, const Halves& reference, std::span<const std::uint8_t> hit) {
    for (const Picture& half : reference) require_comparable(picture, half, hit);
    return relative_mse(blurred(picture, hit), {blurred(reference[0], hit), blurred(reference[1], hit)}, hit);
}

Blocks blocks_of(const Picture& picture, std::span<const std::uint8_t> hit, int side) {
    const glm::ivec2 size = picture.size / side;
    Blocks blocks{{size, {}}, {}};
    for (int block = 0; block < size.x * size.y; ++block) {
        const glm::ivec2 first = side * glm::ivec2(block % size.x, block / size.x);
        glm::dvec4 sum(0.0);  // alpha: pixels that count
        for (int i = 0; i < side * side; ++i) {
            const std::size_t pixel = index_of(first + glm::ivec2(i % side, i / side), picture.size);
            if (counts(hit, pixel)) sum += glm::dvec4(picture.pixels[pixel], 1.0);
        }
        blocks.means.pixels.emplace_back(glm::dvec3(sum) / std::max(sum.a, 1.0));
        blocks.hit.push_back(2.0 * sum.a < side * side ? 0 : 1);
    }
    return blocks;
}

void require_comparable(const Picture& picture, const Picture& reference, std::span<const std::uint8_t> hit) {
    if (picture.size != reference.size || picture.pixels.size() != reference.pixels.size()) {
        throw ToolError(fmt::format("a picture of {}x{} cannot be compared with one of {}x{}", picture.size.x,
                                    picture.size.y, reference.size.x, reference.size.y));
    }
    if (!hit.empty() && hit.size() != picture.pixels.size()) {
        throw ToolError(fmt::format("a mask of {} pixels does not fit {}x{}", hit.size(), picture.size.x,
                                    picture.size.y));
    }
    require_finite(picture, "the picture");
    require_finite(reference, "the reference");
    const bool any = hit.empty() ? !picture.pixels.empty()
                                 : std::any_of(hit.begin(), hit.end(), [](std::uint8_t h) { return h != 0; });
    if (!any) throw ToolError("no pixel counts");
}

std::optional<glm::ivec2> first_not_finite(const Picture& picture) {
    const auto found = std::find_if(picture.pixels.begin(), picture.pixels.end(), [](const glm::vec3& pixel) {
        return !(std::isfinite(pixel.r) && std::isfinite(pixel.g) && std::isfinite(pixel.b));
    });
    if (found == picture.pixels.end()) return std::nullopt;
    const auto index = static_cast<int>(found - picture.pixels.begin());
    return glm::ivec2(index % picture.size.x, index / picture.size.x);
}

double square(glm::dvec3 vector) {
    return glm::dot(vector, vector);
}

double relative_square(glm::dvec3 a, glm::dvec3 r, double mean_square) {
    return relative_product(a, r, r, mean_square);
}

double relative_product(glm::dvec3 a, glm::dvec3 p, glm::dvec3 q, double mean_square) {
    return ratio(glm::dot(a - p, a - q), square(0.5 * (p + q)) + floor_of_square * mean_square);
}

glm::dvec3 mean_vector(const Picture& picture, std::span<const std::uint8_t> hit) {
    return mean_over(picture.pixels.size(), hit,
                     [&](std::size_t i) { return glm::dvec3(picture.pixels[i]); });
}

}  // namespace candela::tools
