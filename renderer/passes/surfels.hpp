#pragma once

#include <cstdint>
#include <glm/mat3x3.hpp>
#include <optional>
#include <vector>

#include "engine/graph/frame_graph.hpp"
#include "renderer/gpu.hpp"
#include "renderer/gpu_types.hpp"
#include "renderer/passes/refinement.hpp"
#include "renderer/passes/scene_upload.hpp"
#include "renderer/passes/vpl_paths.hpp"

namespace candela {

/// Points on the scene's surfaces at which light is gathered and sent on, each with a cell of the surface
/// around it.
struct SurfelSet {
    std::vector<gpu::Vpl> surfels;       ///< without light
    std::vector<gpu::CellPoint> points;  ///< of the cells, in the surfels' order
    std::vector<std::uint32_t> item_of;  ///< by surfel: which item of the scene's geometry it is on
};

/// Points of a cell, in the mean.
inline constexpr std::uint32_t points_a_surfel = 16;

/// The triangles that surfels are spread over.
struct SurfelGround {
    std::vector<gpu::TraceTriangle> triangles;
    std::vector<std::uint32_t> item_of;  ///< by triangle: the item that it is of
    std::vector<bool> double_sided;      ///< by material
};

/// Spreads about `count` surfels evenly in area over the triangles, on both sides of those whose material is
/// double-sided, and cells of `points_a_surfel` points each, in the mean, around them. A cell lies on one
/// side of one item, which hardly bends there; where no surfel is like a point, the point becomes one.
[[nodiscard]] SurfelSet place_surfels(const SurfelGround& ground, std::uint32_t count, std::uint32_t seed);

/// An item's matrix without its rotation and translation: what remains is the same, bit for bit, however it
/// is turned. The upper triangular factor of its Gram matrix (Cholesky), rounded to some four digits.
[[nodiscard]] glm::mat3 shape_of(const glm::mat4& world);

struct Surfels {
    ValueHandle<VplPlan> plan;       ///< how many there are
    ValueHandle<std::uint64_t> set;  ///< another one where they have been spread anew, not just moved
    BufferHandle<gpu::Vpl> surfels;  ///< without light
    BufferHandle<gpu::CellPoint> points;
};

/// Nodes `surfel-spread` (CPU: where they are on their items, with refinement those of the set which is due)
/// and `surfels` (CPU: where they are in the world). They belong to the items of the scene and move with
/// them; they are spread anew where an item comes, goes or changes its size.
[[nodiscard]] Surfels add_surfels(FrameGraph& graph, const Gpu& gpu, const SceneData& scene,
                                  std::optional<ValueHandle<Refinement>> refinement,
                                  const VplSettings& settings);

}  // namespace candela
