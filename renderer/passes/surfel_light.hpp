#pragma once

#include "engine/graph/frame_graph.hpp"
#include "renderer/gpu.hpp"
#include "renderer/passes/bvh.hpp"
#include "renderer/passes/lights.hpp"
#include "renderer/passes/scene_motion.hpp"
#include "renderer/passes/surfels.hpp"
#include "renderer/passes/vpl_trace.hpp"

namespace candela {

/// What surfels see of each other.
struct SurfelVisibility {
    BufferHandle<std::uint32_t> form_factors;  ///< half floats, two a word: `surfel_columns` a row
    BufferHandle<glm::vec2> rows;  ///< by surfel: scale of its factors, share of its hemisphere that is open
    BufferHandle<std::uint32_t> seen_points;  ///< by point of a cell: 1 where its surfel sees it
};

/// How many others a surfel gathers from: where they are many, every n-th stands for all.
struct SurfelColumns {
    std::uint32_t count = 0;   ///< even
    std::uint32_t stride = 1;  ///< n
};
[[nodiscard]] SurfelColumns surfel_columns(std::uint32_t surfels);

/// Node `surfel-visibility` (compute): form factors between surfels, with a ray for each pair that faces each
/// other. Where things move, only rays that pass there are traced anew.
[[nodiscard]] SurfelVisibility add_surfel_visibility(FrameGraph& graph, Gpu& gpu, const Tracing& tracing,
                                                     const Surfels& surfels, ValueHandle<SceneMotion> motion);

/// The real lights.
struct SurfelLights {
    ValueHandle<LightTable> table;
    BufferHandle<gpu::Light> buffer;
};

/// Nodes `surfel-light` (the real lights at the points of the cells, with a shadow ray each) and
/// `surfel-bounce` (what surfels gather of each other, to `bounces`, or until less than
/// 0.1 % is left): the light of surfels, as VPLs.
[[nodiscard]] Vpls add_surfel_light(FrameGraph& graph, Gpu& gpu, const Tracing& tracing,
                                    const Surfels& surfels, const SurfelVisibility& visibility,
                                    const SurfelLights& lights, std::uint32_t bounces);

}  // namespace candela
