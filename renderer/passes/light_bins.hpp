#pragma once

#include <cstdint>
#include <vector>

#include "engine/graph/frame_graph.hpp"
#include "renderer/gpu.hpp"
#include "renderer/passes/lights.hpp"
#include "renderer/passes/view.hpp"

namespace candela {

/// How the view is cut into cells that have a light list each: tiles of pixels, and for clusters slices of
/// depth.
struct ListSettings {
    std::uint32_t tile_size = 16;  ///< pixels along an edge: a multiple of 16, up to 64
    std::uint32_t slices = 24;     ///< of a cluster grid
    bool operator==(const ListSettings&) const = default;
};

/// A grid of cells over the view. Cell (x, y, z) has index (z · tiles.y + y) · tiles.x + x; row 0 is at the
/// bottom.
struct CellGrid {
    glm::uvec2 size{1};   ///< pixels of the target
    glm::uvec2 tiles{1};  ///< cells across and up
    std::uint32_t tile_size = 16;
    std::uint32_t slices = 1;  ///< 1: tiles, which reach from the eye to infinity
    float first_depth = 1.0F;  ///< metres: where slice 0 ends; slice k ends at first_depth · depth_ratio^k
    float depth_ratio = 2.0F;  ///< of the ends of neighbouring slices; the last slice has none
    bool operator==(const CellGrid&) const = default;

    [[nodiscard]] std::uint32_t cells() const { return tiles.x * tiles.y * slices; }
};

/// Lights by cell, before the exact tests. A light without a range is visited everywhere; so are the widest
/// of the others, until the lists fit in their memory.
struct LightBins {
    CellGrid grid;
    std::vector<std::uint32_t> first;  ///< by cell, and the end: where its list begins in `entries`
    std::vector<std::uint32_t>
        entries;  ///< indices of lights, ascending within a cell; the global ones come first
    std::uint32_t global_count = 0;  ///< entries [0, global_count) are every cell's
    bool operator==(const LightBins&) const = default;
};

/// The same on the GPU, for the exact tests to cull.
struct BinBuffers {
    ValueHandle<LightBins> bins;
    BufferHandle<std::uint32_t> first;
    BufferHandle<std::uint32_t> entries;
};

/// Entries of all lists together, beyond which lights become global: 16 MiB of them.
inline constexpr std::uint64_t most_list_entries = 4U << 20U;

/// Sorts lights into the cells that the box around their sphere or cone touches on the screen and in depth.
/// Conservative: no light is missing where it sends anything. O(lights + entries).
[[nodiscard]] LightBins bin_lights(const LightTable& lights, const CameraView& view, const CellGrid& grid);

/// Grid of tiles for a target of that size, or of clusters whose slices are spread evenly in the logarithm of
/// depth over a scene that reaches from `nearest` to `farthest` metres (Olsson et al., "Clustered Deferred
/// and Forward Shading", 2012, section 3.1).
[[nodiscard]] CellGrid tile_grid(glm::uvec2 size, const ListSettings& settings);
[[nodiscard]] CellGrid cluster_grid(glm::uvec2 size, const ListSettings& settings, float nearest,
                                    float farthest);

}  // namespace candela
