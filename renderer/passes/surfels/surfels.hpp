#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include <candela/graph/frame_graph.hpp>
#include "renderer/gpu/gpu.hpp"
#include "renderer/gpu/gpu_types.hpp"
#include "renderer/passes/scene/bvh.hpp"
#include "renderer/passes/scene/scene_motion.hpp"
#include "renderer/passes/scene/scene_upload.hpp"
#include "renderer/passes/surfels/surfel_maps.hpp"
#include "renderer/passes/surfels/surfel_spread.hpp"
#include "renderer/passes/vpls/vpl_counts.hpp"

namespace candela {

/// Where a surfel is.
struct SurfelPlace {
    glm::vec3 position;     ///< metres
    glm::vec3 normal;       ///< unit, or 0: gpu::Surfel
    float area = 0.0F;      ///< m², of its cell
    std::uint32_t map = 0;  ///< gpu::Surfel::map
    bool operator==(const SurfelPlace&) const = default;
};

/// Where a point of a cell is on the triangles of the placement.
struct CellPlace {
    SurfacePoint place;
    float area = 0.0F;         ///< m², that it stands for
    std::uint32_t surfel = 0;  ///< whose cell it is of
    bool operator==(const CellPlace&) const = default;
};

/// The surfels in world space.
struct Surfels {
    ValueHandle<VplCounts> counts;
    ValueHandle<std::uint32_t> point_count;
    /// By surfel, each once. Surfels of the same id in two frames are at the same place and have the same
    /// cell, whatever their indices are.
    ValueHandle<std::vector<std::uint64_t>> ids;
    /// By surfel, each once. Surfels of the same number in two frames are of the same part of the same cell
    /// of an item, also while it moves.
    ValueHandle<std::vector<std::uint64_t>> cells{};
    ValueHandle<std::vector<SurfelPlace>> places{};
    ValueHandle<std::vector<CellPlace>> cell_places{};  ///< by point of their cells
    ValueHandle<SurfelMaps> maps;                       ///< of those that do not emit light
    BufferHandle<gpu::Surfel> surfels;                  ///< those that emit light are the last ones
    BufferHandle<gpu::CellPoint> points;
};

/// Adds node `surfels` (CPU, then upload): moves the surfels to where they are in the world
/// (placed_in_world) and divides cells that surfaces cut (divide_cell). Only cells that are new, that move,
/// or near which something moves, are divided again. Depends on the spread surfels, the scene's layout and
/// placement, BVH, motion, focus and clock, and on its own last result: surfels that stay keep the slots of
/// their depth maps. With a clock whose limit they exceed, a quarter of it get maps of another focus in a
/// frame: see place_maps. `wanted`: VplSettings::count.
[[nodiscard]] Surfels add_surfels(FrameGraph& graph, const Gpu& gpu, const SceneData& scene,
                                  const Tracing& tracing, ValueHandle<SceneMotion> motion,
                                  ValueHandle<SpreadSurfels> spread, ValueHandle<Focus> focus_of_maps,
                                  std::uint32_t wanted, std::optional<ValueHandle<UpdateClock>> clock = {});

}  // namespace candela
