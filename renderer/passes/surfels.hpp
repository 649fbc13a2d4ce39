#pragma once

#include <cstdint>
#include <optional>
#include <span>
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
};

/// Points of a cell, in the mean.
inline constexpr std::uint32_t points_a_surfel = 16;

/// Spreads about `count` surfels evenly in area over the triangles, on both sides of those whose material is
/// double-sided (by index), and cells of `points_a_surfel` points each around them. A cell lies on one side
/// of a surface that hardly bends; where no surfel is like a point, the point becomes one. The same
/// triangles, wherever they are, get the same points.
[[nodiscard]] SurfelSet place_surfels(std::span<const gpu::TraceTriangle> triangles,
                                      const std::vector<bool>& double_sided, std::uint32_t count,
                                      std::uint32_t seed);

struct Surfels {
    ValueHandle<VplPaths> plan;      ///< how many there are
    BufferHandle<gpu::Vpl> surfels;  ///< without light
    BufferHandle<gpu::CellPoint> points;
};

/// Node `surfels` (CPU), with refinement those of the set which is due.
[[nodiscard]] Surfels add_surfels(FrameGraph& graph, const Gpu& gpu, const SceneData& scene,
                                  std::optional<ValueHandle<Refinement>> refinement,
                                  const VplSettings& settings);

}  // namespace candela
