#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <optional>
#include <vector>

#include <candela/graph/frame_graph.hpp>
#include "renderer/gpu.hpp"
#include "renderer/gpu_types.hpp"
#include "renderer/passes/scene/scene_upload.hpp"
#include "renderer/passes/view/refinement.hpp"
#include "renderer/passes/vpls/vpl_paths.hpp"

namespace candela {

/// Surfels: points on the scene's surfaces that gather light and reflect it. Each represents a cell, the part
/// of the surface around it, which is described by sample points.
struct SurfelSet {
    std::vector<gpu::Vpl> surfels;       ///< with flux 0
    std::vector<gpu::CellPoint> points;  ///< of the cells, in the order of the surfels
    std::vector<std::uint32_t> item_of;  ///< by surfel: index into SceneGeometry::items
    std::uint32_t emitting_count = 0;    ///< surfels that emit light: the last ones
};

/// The triangles on which surfels are placed.
struct SurfelGround {
    std::vector<gpu::TraceTriangle> triangles;
    std::vector<std::uint32_t> item_of;  ///< by triangle: index into SceneGeometry::items
    std::vector<bool> double_sided;      ///< by material index
    std::vector<bool> emits;             ///< by material index
};

/// About how many surfels are placed on surfaces that emit light, in addition to `count` on the others. They
/// light the scene directly, so that their number determines how smooth soft shadows are. They have no depth
/// maps, and each pixel traces rays to its share of them: see most_asked.
[[nodiscard]] constexpr std::uint32_t emitting_surfels(std::uint32_t count) {
    return std::clamp(count / 8, 64U, 128U);
}

/// About how many surfels are placed on surfaces that do not emit light, and on those that do.
struct SurfelCounts {
    std::uint32_t reflecting = 0;
    std::uint32_t emitting = 0;
    bool operator==(const SurfelCounts&) const = default;
};

/// Places surfels evenly by area on the triangles that reflect light, and likewise on those that emit it, on
/// both sides where the material is double-sided. Each has a cell of POINTS_A_SURFEL or POINTS_AN_EMITTER
/// points on average. A cell lies on one side of one item, where the surface is nearly flat; a point that
/// fits no surfel becomes a surfel of its own. The points follow the R2 sequence; the surfels are relaxed by
/// Lloyd's algorithm (1982). Equal arguments give equal results.
[[nodiscard]] SurfelSet place_surfels(const SurfelGround& ground, const SurfelCounts& counts,
                                      std::uint32_t seed);

/// The shape of an item: its local-to-world matrix without rotation and translation. It is the upper
/// triangular Cholesky factor of the Gram matrix MᵀM, rounded to about four digits, so that it stays the
/// same, bit for bit, while the item rotates. The first row is negated for mirrored items. For flat items,
/// which have no inverse, it is the upper left 3 × 3 part of `world`.
[[nodiscard]] glm::mat3 shape_of(const glm::mat4& world);

/// The surfels in world space.
struct Surfels {
    ValueHandle<VplPlan> plan;       ///< numbers of surfels and points
    ValueHandle<std::uint64_t> set;  ///< changes when surfels are placed again, not when they only move
    BufferHandle<gpu::Vpl> surfels;  ///< with flux 0
    BufferHandle<gpu::CellPoint> points;
};

/// Adds nodes `surfel-spread` (CPU: places surfels on the items; with refinement, those of the current surfel
/// set) and `surfels` (CPU, then upload: their positions in the world). Surfels belong to the items of the
/// scene and move with them; all are placed again when an item is added, removed or changes its shape. They
/// depend on the scene's layout and placement and on the refinement; `surfel-spread` also on its own last
/// result.
[[nodiscard]] Surfels add_surfels(FrameGraph& graph, const Gpu& gpu, const SceneData& scene,
                                  std::optional<ValueHandle<Refinement>> refinement,
                                  const VplSettings& settings);

}  // namespace candela
