#pragma once

#include <optional>

#include "engine/graph/frame_graph.hpp"
#include "renderer/passes/light_bins.hpp"

namespace candela {

/// Which lights a pixel visits.
enum class LightList : std::uint8_t { all, tile, cluster };

/// The cells that lights are listed by.
struct LightGrid {
    ValueHandle<CellGrid> cells;
    BufferHandle<gpu::CellConstants> constants;
};

/// Node `light-grid`: tiles of pixels.
[[nodiscard]] LightGrid add_tile_grid(FrameGraph& graph, const Gpu& gpu, glm::uvec2 size,
                                      const ListSettings& settings);

/// Node `light-grid`: tiles of pixels, cut into slices of depth.
[[nodiscard]] LightGrid add_cluster_grid(FrameGraph& graph, const Gpu& gpu, ValueHandle<CameraView> camera,
                                         ValueHandle<SceneMetrics> metrics, glm::uvec2 size,
                                         const ListSettings& settings);

/// Light lists of the cells of a view, culled to what truly reaches them.
struct LightLists {
    LightList kind = LightList::tile;
    LightGrid grid;
    FrameView view;
    ValueHandle<LightBins> bins;
    BufferHandle<std::uint32_t> first;  ///< by cell: where its list begins
    BufferHandle<std::uint32_t> count;  ///< by cell: its length
    BufferHandle<std::uint32_t>
        entries;  ///< indices of lights, ascending within a list; the global ones come first
};

/// Node `light-tiles`. With a depth texture, tiles are bound by the nearest and the farthest surface in them,
/// and by a mask of 32 slices between the two (Harada et al., "A 2.5D Culling for Forward+", 2012), which the
/// node `tile-depths` finds.
[[nodiscard]] LightLists add_light_tiles(FrameGraph& graph, Gpu& gpu, ValueHandle<LightTable> lights,
                                         BufferHandle<gpu::Light> light_buffer, const FrameView& view,
                                         const LightGrid& grid, std::optional<TextureHandle> depth);

/// Node `blended-light-tiles`: tiles without bounds in depth, for the blended surfaces in front of what
/// bounds the others. Its lists are empty while the scene has none.
[[nodiscard]] LightLists add_blended_light_tiles(FrameGraph& graph, Gpu& gpu, ValueHandle<LightTable> lights,
                                                 BufferHandle<gpu::Light> light_buffer, const FrameView& view,
                                                 const LightGrid& grid, ValueHandle<SceneLayout> layout);

/// Node `light-clusters`, of clusters.
[[nodiscard]] LightLists add_light_clusters(FrameGraph& graph, Gpu& gpu, ValueHandle<LightTable> lights,
                                            BufferHandle<gpu::Light> light_buffer, const FrameView& view,
                                            const LightGrid& grid);

/// For a pass that shades by lists: declares its reads, and binds them and sets its uniforms when it runs.
void read_light_lists(Pass& pass, const LightLists& lists);
void bind_light_lists(const Gpu& gpu, Execution& run, const gl::Program& program, const LightLists& lists);

}  // namespace candela
