#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/mat3x3.hpp>
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
#include "renderer/passes/surfels/surfel_placement.hpp"
#include "renderer/passes/view/refinement.hpp"
#include "renderer/passes/vpls/vpl_counts.hpp"

namespace candela {

/// The shape of an item: its local-to-world matrix without rotation and translation. It is the upper
/// triangular Cholesky factor of the Gram matrix MᵀM, rounded to about four digits, so that it stays the
/// same, bit for bit, while the item rotates. The first row is negated for mirrored items. For flat items,
/// which have no inverse, it is the upper left 3 × 3 part of `world`.
[[nodiscard]] glm::mat3 shape_of(const glm::mat4& world);

/// Where a surfel is.
struct SurfelPlace {
    glm::vec3 position;     ///< metres
    glm::vec3 normal;       ///< unit, or 0: gpu::Surfel
    float area = 0.0F;      ///< m², of its cell
    std::uint32_t map = 0;  ///< gpu::Surfel::map
    bool operator==(const SurfelPlace&) const = default;
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
    ValueHandle<SurfelMaps> maps;       ///< of those that do not emit light
    BufferHandle<gpu::Surfel> surfels;  ///< those that emit light are the last ones
    BufferHandle<gpu::CellPoint> points;
    std::optional<BufferHandle<gpu::SurfelGroup>> groups{};  ///< VplCounts::groups; none: there are none
    std::uint32_t group_size = 1;                            ///< surfels_a_group
};

/// Adds nodes `surfel-spread` (CPU: places surfels on the items, densely in the foci; with refinement, those
/// of the current surfel set) and `surfels` (CPU, then upload: their positions in the world, where cells are
/// divided that surfaces cut: see divide_cell). Surfels belong to the items of the scene and move with them,
/// and with the triangles of a deformed one; all are placed again when an item is added, removed or changes
/// its shape. Only cells that are new, that move, or near which something moves, are divided again. The nodes
/// depend on the scene's layout and placement, on the foci and on the refinement, and on their own last
/// results: surfels that stay keep the slots of their depth maps. `surfels` also depends on BVH and motion.
[[nodiscard]] Surfels add_surfels(FrameGraph& graph, const Gpu& gpu, const SceneData& scene,
                                  const Tracing& tracing, ValueHandle<SceneMotion> motion,
                                  std::optional<ValueHandle<Refinement>> refinement, const SurfelFoci& foci,
                                  const VplSettings& settings);

}  // namespace candela
