#pragma once

#include <candela/graph/frame_graph.hpp>
#include "renderer/gpu/gpu.hpp"
#include "renderer/passes/scene/scene_upload.hpp"
#include "renderer/passes/view/view.hpp"

namespace candela {

/// Depth and normals of the visible solid surfaces.
struct VisibleSurfaces {
    TextureHandle depth;   ///< depth32f, reversed; 0 where there is no surface
    TextureHandle normal;  ///< rg32f, octahedral encoding, world space
};

/// Adds node `depth-prepass` (raster): depth and normals of the opaque and masked surfaces, without holes of
/// masks. Depends on meshes, materials and view. Textures of `view.size` pixels.
[[nodiscard]] VisibleSurfaces add_depth_prepass(FrameGraph& graph, Gpu& gpu, const SceneData& scene,
                                                const ViewData& view);

}  // namespace candela
