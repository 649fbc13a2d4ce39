#pragma once

#include <candela/graph/frame_graph.hpp>
#include "renderer/gpu/gpu.hpp"
#include "renderer/passes/sky/sky.hpp"
#include "renderer/passes/surfaces/surfaces.hpp"
#include "renderer/passes/view/view.hpp"

namespace candela {

/// Adds nodes `sky-picture` (upload: the picture of the sky, rgba16f; radiance above 65,504 is cut to it) and
/// `background` (raster): writes the radiance of the sky, alpha 0, where there is no surface. Depends on sky,
/// view, the depth of the surfaces and `radiance`. Returns the radiance, modified in place.
[[nodiscard]] TextureHandle add_background(FrameGraph& graph, Gpu& gpu, const Sky& sky, const ViewData& view,
                                           const Surfaces& surfaces, TextureHandle radiance);

}  // namespace candela
