#pragma once

#include <candela/graph/frame_graph.hpp>
#include "renderer/gpu/gpu.hpp"
#include "renderer/passes/scene/scene_upload.hpp"
#include "renderer/passes/surfaces/surfaces.hpp"
#include "renderer/passes/view/view.hpp"

namespace candela {

/// Adds node `depth-prepass` (raster): depth and normal of the opaque and masked surfaces, without holes of
/// masks. Depends on meshes, materials and view.
[[nodiscard]] Surfaces add_depth_prepass(FrameGraph& graph, Gpu& gpu, const SceneData& scene,
                                         const ViewData& view);

}  // namespace candela
