#pragma once

#include <candela/graph/frame_graph.hpp>
#include "renderer/gpu/gpu.hpp"
#include "renderer/passes/scene/scene_upload.hpp"
#include "renderer/passes/shading/lighting.hpp"
#include "renderer/passes/surfaces/surfaces.hpp"
#include "renderer/passes/view/view.hpp"

namespace candela {

/// Results of node `forward`.
struct ForwardResults {
    Surfaces surfaces;       ///< those given, with depth
    TextureHandle radiance;  ///< rgba32f; alpha 1 where there is a surface, else 0
};

/// Adds node `forward` (raster): rasterises the solid surfaces and shades each fragment with the evaluator in
/// shaders/shading/lighting.glsl. Draws the scene several times, adding up, if light lists are longer than
/// lighting_parts. If the depth of the surfaces is known, only visible fragments are shaded. Depends on
/// meshes, materials, lighting, view and that depth. Textures of `view.size` pixels.
[[nodiscard]] ForwardResults add_forward(FrameGraph& graph, Gpu& gpu, const SceneData& scene,
                                         const Lighting& lighting, const ViewData& view,
                                         const Surfaces& surfaces);

}  // namespace candela
