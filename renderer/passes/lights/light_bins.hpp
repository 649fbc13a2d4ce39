#pragma once

#include <candela/configuration.hpp>

#include <cstdint>
#include <vector>

#include <candela/graph/frame_graph.hpp>
#include "renderer/gpu/gpu.hpp"
#include "renderer/passes/lights/light_table.hpp"
#include "renderer/passes/view/view.hpp"

namespace candela {

/// A grid of cells over the view. Cell (x, y, z) has index (z · tiles.y + y) · tiles.x + x. Row y = 0 is at
/// the bottom of the screen, slice z = 0 nearest to the eye.
struct CellGrid {
    glm::uvec2 size{1};            ///< of the rendered picture, pixels
    glm::uvec2 tiles{1};           ///< tiles in x and y
    std::uint32_t tile_size = 16;  ///< pixels along an edge
    std::uint32_t slices = 1;      ///< 1: no slices; tiles reach from the eye to infinity
    float first_depth = 1.0F;      ///< metres: end of slice 0; slice k ends at first_depth · depth_ratio^k
    float depth_ratio = 2.0F;      ///< ratio of the ends of neighbouring slices; the last slice has no end
    bool operator==(const CellGrid&) const = default;

    [[nodiscard]] std::uint32_t cells() const { return tiles.x * tiles.y * slices; }
};

/// Lights by cell, a conservative result before the exact tests on the GPU. Global lights are in no list,
/// because every cell visits them: lights without a range, and the widest of the others if the lists would
/// exceed their memory.
struct LightBins {
    CellGrid grid;
    std::vector<std::uint32_t> first;  ///< by cell: where its list begins in `entries`; one more for the end
    /// Indices of lights: global lights, then list after list; ascending within each.
    std::vector<std::uint32_t> entries;
    std::uint32_t global_count = 0;  ///< entries [0, global_count) are the global lights
    bool operator==(const LightBins&) const = default;

    /// Entries of the longest list, the global ones included.
    [[nodiscard]] std::uint32_t longest() const;
};

/// The same on the GPU, as input of the exact tests.
struct BinBuffers {
    ValueHandle<LightBins> bins;
    BufferHandle<std::uint32_t> first;
    BufferHandle<std::uint32_t> entries;
};

/// Most entries of all lists together (16 MiB); beyond that, lights become global.
inline constexpr std::uint64_t most_list_entries = 4U << 20U;

/// Sorts lights into the cells that the bounding box of their sphere or cone touches, on the screen and in
/// depth. Conservative: a light is in every cell that it sends light into. O(lights + entries).
[[nodiscard]] LightBins bin_lights(const LightTable& lights, const CameraView& view, const CellGrid& grid);

/// Grid of tiles for a picture of `size` pixels, or of clusters. The slices of clusters are spaced evenly in
/// the logarithm of depth, for a scene that lies between the depths `nearest` and `farthest` in metres
/// (Olsson et al., "Clustered Deferred and Forward Shading", 2012, section 3.1).
[[nodiscard]] CellGrid tile_grid(glm::uvec2 size, const ListSettings& settings);
[[nodiscard]] CellGrid cluster_grid(glm::uvec2 size, const ListSettings& settings, float nearest,
                                    float farthest);

}  // namespace candela
