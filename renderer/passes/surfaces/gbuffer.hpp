#pragma once

#include <candela/graph/frame_graph.hpp>
#include "renderer/gpu/gpu.hpp"
#include "renderer/passes/scene/scene_upload.hpp"
#include "renderer/passes/surfaces/surfaces.hpp"
#include "renderer/passes/view/view.hpp"

namespace candela {

/// Adds node `gbuffer` (raster): all parts of the opaque and masked surfaces, without holes of masks. Depends
/// on meshes, materials and view.
[[nodiscard]] Surfaces add_gbuffer(FrameGraph& graph, Gpu& gpu, const SceneData& scene, const ViewData& view,
                                   MaterialParts parts);

}  // namespace candela
