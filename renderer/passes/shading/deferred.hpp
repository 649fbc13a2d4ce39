#pragma once

#include <candela/graph/frame_graph.hpp>
#include "renderer/gpu/gpu.hpp"
#include "renderer/passes/shading/lighting.hpp"
#include "renderer/passes/surfaces/surfaces.hpp"
#include "renderer/passes/view/view.hpp"

namespace candela {

/// Adds node `deferred` (compute): shades the surfaces with the evaluator in shaders/shading/lighting.glsl,
/// by all lights or by the light list of each pixel's cell. Takes several dispatches if lists are longer than
/// lighting_parts. Depends on all parts of the surfaces, the lighting and the view. Returns reflected
/// radiance, rgba32f, `view.size` pixels, alpha 1 where there is a surface.
[[nodiscard]] TextureHandle add_deferred(FrameGraph& graph, Gpu& gpu, const Surfaces& surfaces,
                                         const Lighting& lighting, const ViewData& view);

}  // namespace candela
