#pragma once

#include <candela/graph/frame_graph.hpp>
#include "renderer/gpu/gpu.hpp"
#include "renderer/passes/scene/scene_upload.hpp"
#include "renderer/passes/surfaces/surfaces.hpp"
#include "renderer/passes/view/view.hpp"

namespace candela {

/// Adds node `emission` (raster): draws the visible solid surfaces that emit light again and adds what they
/// emit. Blended surfaces add it themselves: add_transparent. Depends on meshes, materials, view, the
/// depth of the surfaces and `radiance`. Returns the radiance, modified in place.
[[nodiscard]] TextureHandle add_emission(FrameGraph& graph, Gpu& gpu, const SceneData& scene,
                                         const ViewData& view, const Surfaces& surfaces,
                                         TextureHandle radiance);

}  // namespace candela
