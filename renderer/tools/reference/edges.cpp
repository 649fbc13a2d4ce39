#include "renderer/tools/reference/edges.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace candela::reference {

namespace {

using Layer = PixelTrait::Layer;

/// Sine of the largest bend that does not count as an edge.
constexpr float flat_sine = 0.1F;

bool is_flat(const Layer& a, const Layer& b) {
    const glm::vec3 between = b.position - a.position;
    const float reach = flat_sine * glm::length(between);
    return std::abs(glm::dot(between, a.face)) <= reach && std::abs(glm::dot(between, b.face)) <= reach;
}

/// Whether a light that faces both sides is occluded on only one of them. Both lists are in the lights'
/// order.
bool is_shadow_edge(const std::vector<LightState>& a, const std::vector<LightState>& b) {
    auto at = b.begin();
    return std::ranges::any_of(a, [&](const LightState& state) {
        at = std::find_if(at, b.end(), [&](const LightState& other) { return other.light >= state.light; });
        return at != b.end() && at->light == state.light && at->is_lit != state.is_lit;
    });
}

bool are_alike(const Layer& a, const Layer& b) {
    return a.part == b.part && is_flat(a, b) && !is_shadow_edge(a.lights, b.lights);
}

bool is_edge(const PixelTrait& a, const PixelTrait& b) {
    return !std::ranges::equal(a.layers, b.layers, are_alike);
}

/// Replaces each of `count` pixels, `stride` apart, by the maximum within `radius` along this axis.
void spread(std::vector<std::uint8_t>& mask, std::size_t first, std::size_t stride, int count, int radius) {
    std::vector<std::uint8_t> line(static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < line.size(); ++i) line[i] = mask[first + i * stride];
    for (int i = 0; i < count; ++i) {
        const auto from = line.begin() + std::max(i - radius, 0);
        const auto to = line.begin() + std::min(i + radius + 1, count);
        mask[first + static_cast<std::size_t>(i) * stride] = *std::max_element(from, to);
    }
}

}  // namespace

std::vector<std::uint8_t> find_edges(const std::vector<PixelTrait>& pixels, glm::uvec2 size, int radius) {
    std::vector<std::uint8_t> mask(pixels.size(), 0);
    const auto mark = [&](std::size_t a, std::size_t b) {
        if (is_edge(pixels[a], pixels[b])) mask[a] = mask[b] = 1;
    };
    for (std::size_t y = 0; y < size.y; ++y) {
        for (std::size_t x = 0; x < size.x; ++x) {
            const std::size_t i = y * size.x + x;
            if (x + 1 < size.x) mark(i, i + 1);
            if (y + 1 < size.y) mark(i, i + size.x);
        }
    }
    const glm::ivec2 extent(size);
    for (std::size_t y = 0; y < size.y; ++y) spread(mask, y * size.x, 1, extent.x, radius);
    for (std::size_t x = 0; x < size.x; ++x) spread(mask, x, size.x, extent.y, radius);
    return mask;
}

}  // namespace candela::reference
