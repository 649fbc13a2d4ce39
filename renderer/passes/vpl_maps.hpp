#pragma once

#include "engine/graph/frame_graph.hpp"
#include "renderer/gpu.hpp"
#include "renderer/passes/bvh.hpp"
#include "renderer/passes/vpl_constants.hpp"
#include "renderer/passes/vpl_trace.hpp"

namespace candela {

/// What is drawn of VPLs.
struct MappedVpls {
    ValueHandle<VplPaths> paths;
    BufferHandle<gpu::Vpl> vpls;  ///< their map, its origin, and their normal
};

/// Node `vpl-maps`: the depth of the scene as each VPL sees it in the hemisphere above its surface. A texel
/// is traced through the BVH and not rasterised: large triangles are then exact in the curved map, whatever
/// their tessellation, and one map costs as many rays as it has texels, however large the scene. Draws the
/// maps that are due, in one call; all of them where the atlas is new.
/// Gives an array of depth32f, reversed: shaders/vpl_atlas.glsl.
[[nodiscard]] TextureHandle add_vpl_maps(FrameGraph& graph, Gpu& gpu, const Tracing& tracing,
                                         const MappedVpls& vpls, const VplCommon& common);

}  // namespace candela
