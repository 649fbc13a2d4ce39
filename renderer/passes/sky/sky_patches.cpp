#include "renderer/passes/sky/sky_patches.hpp"

#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include <glm/geometric.hpp>

#include "renderer/passes/view/r2_sequence.hpp"

namespace candela {
namespace {

SkyPatch patch_of(const SkyGrid& grid, glm::uvec2 first, glm::uvec2 last) {
    SkyPatch patch{.first = first, .last = last};
    for (std::uint32_t y = first.y; y < last.y; ++y) {
        for (std::uint32_t x = first.x; x < last.x; ++x) {
            patch.light += grid.at(x, y).light;
            patch.moment += grid.at(x, y).moment;
        }
    }
    return patch;
}

/// Sums over the cells in a cone around a unit direction.
struct ConeLight {
    glm::dvec3 light{0.0};
    glm::dvec3 moment{0.0};
};

ConeLight light_in_cone(const SkyGrid& grid, glm::vec3 axis, float cosine) {
    ConeLight sum;
    for (const SkyGrid::Cell& cell : grid.cells) {
        if (glm::dot(cell.moment, axis) > cosine * glm::length(cell.moment)) {
            sum.light += cell.light;
            sum.moment += cell.moment;
        }
    }
    return sum;
}

/// Takes the surroundings of the brightest cell out of the grid if they are a sun: within a radius of 1
/// degree lie a twentieth of `all` light, and most of what lies within 2 degrees.
std::optional<SkySun> take_sun(SkyGrid& grid, double all) {
    const auto brightest = std::ranges::max_element(
        grid.cells, {}, [](const SkyGrid::Cell& cell) { return sum_of_channels(cell.light); });
    if (brightest->moment == glm::vec3(0.0F)) return std::nullopt;
    // The brightest cell may be at the sun's edge.
    const glm::dvec3 near = light_in_cone(grid, glm::normalize(brightest->moment), around_sun_cosine).moment;
    const glm::vec3 axis(glm::normalize(near));
    const ConeLight sun = light_in_cone(grid, axis, sun_cosine);
    const double light = sum_of_channels(sun.light);
    const double around = sum_of_channels(light_in_cone(grid, axis, around_sun_cosine).light);
    if (light < 0.05 * all || light < 0.8 * around) return std::nullopt;
    for (SkyGrid::Cell& cell : grid.cells) {
        if (glm::dot(cell.moment, axis) > sun_cosine * glm::length(cell.moment)) cell = {};
    }
    return SkySun{glm::vec3(glm::normalize(sun.moment)), glm::vec3(sun.light)};
}

std::vector<SkySun> take_suns(SkyGrid& grid) {
    const double all = sum_of_channels(patch_of(grid, glm::uvec2(0), grid.size).light);
    std::vector<SkySun> suns;
    while (suns.size() < MOST_SKY_SUNS) {
        const std::optional<SkySun> sun = take_sun(grid, all);
        if (!sun) break;
        suns.push_back(*sun);
    }
    return suns;
}

/// Width in azimuth, at its middle, and in polar angle; radians. 0 where it is one cell wide.
glm::vec2 extent_of(const SkyGrid& grid, const SkyPatch& patch) {
    constexpr auto half_turn = std::numbers::pi_v<float>;
    const glm::vec2 cells(patch.last - patch.first);
    const glm::vec2 share = cells / glm::vec2(grid.size);
    const float middle =
        half_turn * 0.5F * static_cast<float>(patch.first.y + patch.last.y) / static_cast<float>(grid.size.y);
    return {cells.x > 1.0F ? 2.0F * half_turn * share.x * std::sin(middle) : 0.0F,
            cells.y > 1.0F ? half_turn * share.y : 0.0F};
}

/// A patch, and how much it should be split.
struct Candidate {
    SkyPatch patch;
    float need = 0.0F;
};

Candidate candidate_of(const SkyGrid& grid, glm::uvec2 first, glm::uvec2 last) {
    const SkyPatch patch = patch_of(grid, first, last);
    const glm::vec2 extent = extent_of(grid, patch);
    return {patch, static_cast<float>(sum_of_channels(patch.light)) * std::max(extent.x, extent.y)};
}

/// Where the light along an axis (0: columns, 1: rows) is divided most evenly.
std::uint32_t median(const SkyGrid& grid, const SkyPatch& patch, int axis) {
    std::vector<double> light(patch.last[axis] - patch.first[axis], 0.0);
    for (std::uint32_t y = patch.first.y; y < patch.last.y; ++y) {
        for (std::uint32_t x = patch.first.x; x < patch.last.x; ++x) {
            const std::uint32_t along = axis == 0 ? x - patch.first.x : y - patch.first.y;
            light[along] += static_cast<double>(sum_of_channels(grid.at(x, y).light));
        }
    }
    const double half = 0.5 * std::accumulate(light.begin(), light.end(), 0.0);
    double before = 0.0;
    std::uint32_t at = 0;
    while (at + 2 < light.size() && before + 0.5 * light[at] < half) {
        before += light[at++];
    }
    // `at` cells are in the first half; neither half is empty.
    return patch.first[axis] + std::max(at, 1U);
}

/// A direction of the patch in the picture, drawn by radiance.
glm::vec3 drawn_direction(const SkyGrid& grid, const SkyPatch& patch, glm::vec2 u) {
    std::vector<float> until;
    float sum = 0.0F;
    for (std::uint32_t y = patch.first.y; y < patch.last.y; ++y) {
        for (std::uint32_t x = patch.first.x; x < patch.last.x; ++x) {
            sum += sum_of_channels(grid.at(x, y).light);
            until.push_back(sum);
        }
    }
    const auto found = std::ranges::upper_bound(until, u.x * sum);
    const auto i = static_cast<std::uint32_t>(
        std::min<std::ptrdiff_t>(found - until.begin(), static_cast<std::ptrdiff_t>(until.size()) - 1));
    const float before = i == 0 ? 0.0F : until[i - 1];
    const float inside =
        until[i] > before ? std::clamp((u.x * sum - before) / (until[i] - before), 0.0F, 1.0F) : 0.5F;
    const std::uint32_t width = patch.last.x - patch.first.x;
    const glm::vec2 corner(patch.first + glm::uvec2(i % width, i / width));
    return grid_direction((corner + glm::vec2(inside, u.y)) / glm::vec2(grid.size));
}

}  // namespace

glm::vec3 rotated_sky(glm::vec3 direction, float rotation) {
    const float c = std::cos(rotation);
    const float s = std::sin(rotation);
    return {c * direction.x + s * direction.z, direction.y, c * direction.z - s * direction.x};
}

SplitSky split_sky(const SkyPicture* picture, std::uint32_t count) {
    SkyGrid grid = sky_grid(picture);
    SplitSky sky{.suns = take_suns(grid), .grid = nullptr, .patches = {}};
    const auto less = [](const Candidate& a, const Candidate& b) { return a.need < b.need; };
    std::vector<Candidate> heap{candidate_of(grid, glm::uvec2(0), grid.size)};
    while (heap.size() < count && heap.front().need > 0.0F) {
        std::ranges::pop_heap(heap, less);
        const SkyPatch whole = heap.back().patch;
        heap.pop_back();
        const glm::vec2 extent = extent_of(grid, whole);
        const int axis = extent.x > extent.y ? 0 : 1;
        const std::uint32_t middle = median(grid, whole, axis);
        glm::uvec2 last_of_lower = whole.last;
        glm::uvec2 first_of_upper = whole.first;
        last_of_lower[axis] = first_of_upper[axis] = middle;
        heap.push_back(candidate_of(grid, whole.first, last_of_lower));
        std::ranges::push_heap(heap, less);
        heap.push_back(candidate_of(grid, first_of_upper, whole.last));
        std::ranges::push_heap(heap, less);
    }
    for (const Candidate& candidate : heap) {
        sky.patches.push_back(candidate.patch);
    }
    sky.grid = std::make_shared<const SkyGrid>(std::move(grid));
    return sky;
}

std::vector<gpu::SkyPatch> place_sky(const SplitSky& sky, const Environment& environment,
                                     std::uint32_t sample) {
    std::vector<gpu::SkyPatch> placed;
    for (const SkyPatch& patch : sky.patches) {
        const double weight = sum_of_channels(patch.light);
        if (weight <= 0.0) continue;
        const glm::vec3 facing = environment.radiance * glm::vec3(std::numbers::pi * patch.light);
        if (sample > 0) {
            const glm::dvec2 start = r2_point(static_cast<std::uint32_t>(placed.size()), glm::dvec2(0.5));
            const glm::vec2 u(r2_point(sample, start));
            const glm::vec3 direction = drawn_direction(*sky.grid, patch, u);
            placed.push_back({.direction = rotated_sky(direction, environment.rotation),
                              .half_width2 = 0.0F,
                              .light = facing});
            continue;
        }
        // Share of the light that arrives from the mean direction. It is 1 - h²/3 for a small square of
        // directions of half width h.
        const double share = std::min(glm::length(patch.moment) / weight, 1.0);
        const glm::vec3 direction =
            rotated_sky(glm::vec3(glm::normalize(patch.moment)), environment.rotation);
        placed.push_back({.direction = direction,
                          .half_width2 = static_cast<float>(3.0 * (1.0 - share)),
                          .light = static_cast<float>(share) * facing});
    }
    return placed;
}

}  // namespace candela
