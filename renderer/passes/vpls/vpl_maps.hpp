#pragma once

#include <cstdint>
#include <optional>
#include <variant>

#include <candela/graph/frame_graph.hpp>
#include "renderer/gpu/gpu.hpp"
#include "renderer/passes/scene/bvh.hpp"
#include "renderer/passes/scene/scene_motion.hpp"
#include "renderer/passes/surfels/surfel_maps.hpp"
#include "renderer/passes/surfels/surfel_updates.hpp"
#include "renderer/passes/vpls/vpl_constants.hpp"
#include "renderer/passes/vpls/vpl_counts.hpp"

namespace candela {

/// Surfels that have depth maps. Those that stay keep their maps where nothing has moved.
struct MappedSurfels {
    BufferHandle<gpu::Surfel> surfels;
    ValueHandle<SurfelMaps> maps;
    ValueHandle<SceneMotion> motion;
    std::optional<ValueHandle<SurfelTasks>> tasks;  ///< none: all that has changed is traced
};

/// VPLs that have depth maps: VplCounts::mapped.
struct MappedVpls {
    ValueHandle<VplCounts> counts;
    std::variant<BufferHandle<gpu::TracedVpl>, MappedSurfels> records;
};

/// None for VPLs on paths.
[[nodiscard]] std::optional<ValueHandle<SurfelMaps>> surfel_maps(const MappedVpls& vpls);

/// Adds node `vpl-maps` (compute): a map of the planes that each VPL sees in the hemisphere above it, in the
/// hemi-octahedral mapping (Cigolle et al., "A Survey of Efficient Representations for Independent Unit
/// Vectors", 2014), or, of a surfel that is far from the focus, a perspective one of the focus. Each
/// texel traces a ray through the BVH. In contrast to rasterised meshes, large triangles are therefore exact
/// in a curved mapping whatever their tessellation, and a map costs as many rays as it has texels, however
/// large the scene is. One dispatch covers all maps. With surfels, only new maps are traced
/// (SurfelMaps::keys), and of the others those texels whose rays pass through changed boxes; slots that no
/// surfel has any more are cleared. With tasks (add_surfel_updates), only maps of the surfels whose turn it
/// is are traced. Depends on the VPLs, the BVH and the constants; with surfels also on motion, tasks and its
/// own last result.
[[nodiscard]] VplMaps add_vpl_maps(FrameGraph& graph, Gpu& gpu, const Tracing& tracing,
                                   const MappedVpls& vpls, const VplCommon& common);

}  // namespace candela
