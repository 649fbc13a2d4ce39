#include "renderer/passes/lights/light_bins.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>

#include "renderer/passes/lights/light_kind.hpp"

namespace candela {
namespace {

/// Bounding sphere of a light's reach, in view space.
struct Reach {
    glm::vec3 centre;
    float radius;
};

Reach reach_of(const gpu::Light& light, const CameraView& view) {
    const auto [centre, radius] = light_kinds[light.kind]->bounds(light);
    const glm::vec3 in_view(view.view_from_world * glm::vec4(centre, 1.0F));
    // Enlarged by a bound on the rounding error of the centre.
    return {in_view, radius * 1.0001F + 1e-6F * (glm::length(in_view) + glm::length(view.eye))};
}

/// Cells [lower, upper) in x, y and z; empty where they are equal.
struct CellRange {
    glm::uvec3 lower{0};
    glm::uvec3 upper{0};

    [[nodiscard]] std::uint64_t cells() const {
        const glm::uvec3 extent = upper - lower;
        return static_cast<std::uint64_t>(extent.x) * extent.y * extent.z;
    }
};

/// Range of tiles between two window coordinates in pixels, enlarged by a pixel on each side.
void to_tiles(float from, float to, std::uint32_t tile_size, std::uint32_t tiles, std::uint32_t& lower,
              std::uint32_t& upper) {
    const auto size = static_cast<float>(tile_size);
    const auto most = static_cast<float>(tiles);
    lower = static_cast<std::uint32_t>(std::clamp(std::floor((from - 1.0F) / size), 0.0F, most));
    upper = static_cast<std::uint32_t>(std::clamp(std::floor((to + 1.0F) / size) + 1.0F, 0.0F, most));
    upper = std::max(lower, upper);
}

/// Slice that contains a depth in metres. Depths before the first or behind the last slice are clamped to it.
std::uint32_t slice_of(const CellGrid& grid, float depth) {
    if (!(depth > grid.first_depth)) return 0;
    const float slice = 1.0F + std::floor(std::log(depth / grid.first_depth) / std::log(grid.depth_ratio));
    return static_cast<std::uint32_t>(std::min(slice, static_cast<float>(grid.slices - 1)));
}

/// The cells that the bounding box of a sphere touches.
CellRange touched(const Reach& reach, const CameraView& view, const CellGrid& grid) {
    CellRange all{glm::uvec3(0), {grid.tiles, grid.slices}};
    const float depth = -reach.centre.z;
    const float nearest = depth - reach.radius;
    const float farthest = depth + reach.radius;
    if (!std::isfinite(reach.radius)) return all;
    if (farthest <= 0.0F && !view.orthographic) return {};

    CellRange range = all;
    if (grid.slices > 1) {
        // One more slice on each side: shaders round the logarithm differently.
        range.lower.z = slice_of(grid, nearest);
        range.lower.z -= range.lower.z > 0 ? 1 : 0;
        range.upper.z = std::min(slice_of(grid, farthest) + 2, grid.slices);
    }
    if (nearest <= 0.0F && !view.orthographic) {
        return range;
    }  // the sphere crosses the eye's plane: the whole screen

    const glm::mat4& clip = view.clip_from_view;
    for (int axis = 0; axis < 2; ++axis) {
        const float low = reach.centre[axis] - reach.radius;
        const float high = reach.centre[axis] + reach.radius;
        // NDC of x at depth d: scale·x / d + shift in perspective, scale·x + shift in an orthographic view.
        float from = clip[axis][axis] * low;
        float to = clip[axis][axis] * high;
        float shift = clip[3][axis];
        if (!view.orthographic) {
            from /= low < 0.0F ? nearest : farthest;
            to /= high < 0.0F ? farthest : nearest;
            shift = -clip[2][axis];
        }
        const auto pixels = static_cast<float>(grid.size[axis]);
        to_tiles((from + shift + 1.0F) * 0.5F * pixels, (to + shift + 1.0F) * 0.5F * pixels, grid.tile_size,
                 grid.tiles[axis], range.lower[axis], range.upper[axis]);
    }
    return range;
}

template <class Visit>
void each_cell(const CellRange& range, const CellGrid& grid, Visit visit) {
    for (std::uint32_t z = range.lower.z; z < range.upper.z; ++z) {
        for (std::uint32_t y = range.lower.y; y < range.upper.y; ++y) {
            const std::uint32_t row = (z * grid.tiles.y + y) * grid.tiles.x;
            for (std::uint32_t x = range.lower.x; x < range.upper.x; ++x) {
                visit(row + x);
            }
        }
    }
}

/// Chooses the lights that every cell visits: lights without a range and, until the entries of the others fit
/// into `most_list_entries`, the lights with the most cells. Wide lights stay in lists as long as possible:
/// one list entry costs less than evaluating a light at pixels that it does not reach.
std::vector<bool> choose_global(const LightTable& lights, const std::vector<CellRange>& ranges) {
    std::vector<bool> global(ranges.size(), false);
    std::vector<std::uint32_t> listed;
    std::uint64_t entries = 0;
    for (std::uint32_t i = 0; i < ranges.size(); ++i) {
        global[i] = std::isinf(lights.entries[i].light.range);
        if (global[i]) continue;
        entries += ranges[i].cells();
        listed.push_back(i);
    }
    if (entries <= most_list_entries) return global;
    std::stable_sort(listed.begin(), listed.end(),
                     [&](auto a, auto b) { return ranges[a].cells() > ranges[b].cells(); });
    for (const std::uint32_t i : listed) {
        if (entries <= most_list_entries) break;
        entries -= ranges[i].cells();
        global[i] = true;
    }
    return global;
}

}  // namespace

std::uint32_t LightBins::longest() const {
    std::uint32_t own = 0;
    for (std::size_t cell = 0; cell + 1 < first.size(); ++cell) {
        own = std::max(own, first[cell + 1] - first[cell]);
    }
    return global_count + own;
}

LightBins bin_lights(const LightTable& lights, const CameraView& view, const CellGrid& grid) {
    LightBins bins{.grid = grid, .first = {}, .entries = {}, .global_count = 0};
    std::vector<CellRange> ranges;
    ranges.reserve(lights.entries.size());
    for (const LightTable::Entry& entry : lights.entries) {
        ranges.push_back(touched(reach_of(entry.light, view), view, grid));
    }
    const std::vector<bool> global = choose_global(lights, ranges);
    for (std::uint32_t i = 0; i < ranges.size(); ++i) {
        if (global[i]) bins.entries.push_back(i);
    }
    bins.global_count = static_cast<std::uint32_t>(bins.entries.size());

    // Counting sort by cell: count, prefix sum, then write each light to the next position of each of its
    // cells.
    std::vector<std::uint32_t> next(grid.cells() + 1, 0);
    for (std::uint32_t i = 0; i < ranges.size(); ++i) {
        if (!global[i]) each_cell(ranges[i], grid, [&](std::uint32_t cell) { ++next[cell + 1]; });
    }
    next[0] = bins.global_count;
    std::partial_sum(next.begin(), next.end(), next.begin());
    bins.first = next;
    bins.entries.resize(next.back());
    for (std::uint32_t i = 0; i < ranges.size(); ++i) {
        if (!global[i]) {
            each_cell(ranges[i], grid, [&](std::uint32_t cell) { bins.entries[next[cell]++] = i; });
        }
    }
    return bins;
}

CellGrid tile_grid(glm::uvec2 size, const ListSettings& settings) {
    return {.size = size,
            .tiles = (size + settings.tile_size - 1U) / settings.tile_size,
            .tile_size = settings.tile_size};
}

CellGrid cluster_grid(glm::uvec2 size, const ListSettings& settings, float nearest, float farthest) {
    CellGrid grid = tile_grid(size, settings);
    grid.slices = std::max(settings.slices, 2U);
    grid.first_depth = nearest;
    grid.depth_ratio =
        std::pow(std::max(farthest / nearest, 1.001F), 1.0F / static_cast<float>(grid.slices - 1));
    return grid;
}

}  // namespace candela
