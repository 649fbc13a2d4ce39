#pragma once

#include <cstdint>
#include <optional>

#include "engine/graph/frame_graph.hpp"
#include "renderer/gpu.hpp"
#include "renderer/passes/bvh.hpp"
#include "renderer/passes/scene_motion.hpp"
#include "renderer/passes/vpl_constants.hpp"
#include "renderer/passes/vpl_trace.hpp"

namespace candela {

/// What is drawn of VPLs.
struct MappedVpls {
    ValueHandle<VplPlan> plan;
    BufferHandle<gpu::Vpl> vpls;  ///< their map, its origin, and their normal
    /// Of surfels, which keep their maps as far as nothing moves: where it did, and the number of their set.
    std::optional<ValueHandle<SceneMotion>> motion{};
    std::optional<ValueHandle<std::uint64_t>> set{};
};

/// Node `vpl-maps`: the depth of the scene as each VPL sees it in the hemisphere above its surface. A texel
/// is traced through the BVH and not rasterised: large triangles are then exact in the curved map, whatever
/// their tessellation, and one map costs as many rays as it has texels, however large the scene. All of
/// them are drawn in one call; of surfels only those texels whose rays pass where something has moved.
/// Gives an array of depth32f, reversed: shaders/vpl_atlas.glsl.
[[nodiscard]] TextureHandle add_vpl_maps(FrameGraph& graph, Gpu& gpu, const Tracing& tracing,
                                         const MappedVpls& vpls, const VplCommon& common);

}  // namespace candela
