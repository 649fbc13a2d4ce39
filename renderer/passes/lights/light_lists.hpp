#pragma once

#include <optional>

#include <candela/graph/frame_graph.hpp>
#include "renderer/passes/lights/light_bins.hpp"
#include "renderer/passes/lights/lights.hpp"

namespace candela {

/// The cells of the light lists, for the CPU and for shaders.
struct LightGrid {
    ValueHandle<CellGrid> cells;
    BufferHandle<gpu::CellConstants> constants;
};

/// Adds node `light-grid` (CPU): a grid of screen tiles. Depends on no other node.
[[nodiscard]] LightGrid add_tile_grid(FrameGraph& graph, const Gpu& gpu, glm::uvec2 size,
                                      const ListSettings& settings);

/// Adds node `light-grid` (CPU): a grid of clusters, whose slices cover the depths of the scene's bounding
/// sphere. Depends on the camera and the scene's metrics.
[[nodiscard]] LightGrid add_cluster_grid(FrameGraph& graph, const Gpu& gpu, ValueHandle<CameraView> camera,
                                         ValueHandle<SceneMetrics> metrics, glm::uvec2 size,
                                         const ListSettings& settings);

/// What light lists are made of.
struct ListInputs {
    SceneLights lights;
    ViewData view;
    LightGrid grid;
};

/// Note on a buffer (FrameGraph::note): it holds the lengths of light lists, by cell of this grid.
struct ListLengths {
    ValueHandle<CellGrid> grid;
};

/// Light lists by cell.
struct LightLists {
    LightList kind = LightList::tile;
    ListInputs inputs;
    ValueHandle<LightBins> bins;
    BufferHandle<std::uint32_t> first;  ///< by cell: where its list begins
    BufferHandle<std::uint32_t> count;  ///< by cell: its length
    /// Indices of lights: global lights, then list after list; ascending within each.
    BufferHandle<std::uint32_t> entries;
};

/// Adds nodes `light-tiles-bins` (CPU) and `light-tiles` (compute): light lists of screen tiles (tiled
/// shading: Olsson and Assarsson, "Tiled Shading", 2011). With a depth texture, node `tile-depths` (compute)
/// finds the nearest and the farthest surface of each tile and a mask of the 32 depth slices between them
/// that contain surfaces, and lists are culled by both (Harada et al., "A 2.5D Culling for Forward+", 2012).
/// They depend on lights, view, grid and depth.
[[nodiscard]] LightLists add_light_tiles(FrameGraph& graph, Gpu& gpu, const ListInputs& inputs,
                                         std::optional<TextureHandle> depth);

/// Adds nodes `blended-light-tiles-bins` (CPU) and `blended-light-tiles` (compute): light lists of tiles
/// without depth bounds, for blended surfaces, which lie in front of the surfaces that bound the other lists.
/// They depend on lights, view, grid and layout. The lists are empty while the scene has no blended surfaces.
[[nodiscard]] LightLists add_blended_light_tiles(FrameGraph& graph, Gpu& gpu, const ListInputs& inputs,
                                                 ValueHandle<SceneLayout> layout);

/// Adds nodes `light-clusters-bins` (CPU) and `light-clusters` (compute): light lists of clusters (Olsson et
/// al., "Clustered Deferred and Forward Shading", 2012). They depend on lights, view and grid.
[[nodiscard]] LightLists add_light_clusters(FrameGraph& graph, Gpu& gpu, const ListInputs& inputs);

/// For a pass whose shader includes light_list.glsl with LIGHT_LIST_CELLS.
void read_light_lists(Pass& pass, const LightLists& lists);

}  // namespace candela
