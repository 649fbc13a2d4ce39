#pragma once

#include <optional>

#include <candela/graph/frame_graph.hpp>
#include "renderer/gpu/gpu.hpp"
#include "renderer/passes/scene/scene_upload.hpp"
#include "renderer/passes/shading/lighting.hpp"
#include "renderer/passes/view/view.hpp"

namespace candela {

/// Result of a shading path for the solid (opaque and masked) surfaces.
struct ShadedSurfaces {
    TextureHandle radiance;  ///< rgba32f; alpha 1 where there is a surface, else 0
    TextureHandle depth;     ///< depth32f, reversed; 0 where there is no surface
};

/// Adds node `forward` (raster): rasterises the solid surfaces and shades each fragment with the evaluator in
/// shaders/shading/lighting.glsl. Draws the scene several times, adding up, if light lists are longer than
/// lighting_parts. With the depth of a pre-pass, only visible fragments are shaded. Depends on meshes,
/// materials, lighting, view and `prepass_depth`. Textures of `view.size` pixels.
[[nodiscard]] ShadedSurfaces add_forward(FrameGraph& graph, Gpu& gpu, const SceneData& scene,
                                         const Lighting& lighting, const ViewData& view,
                                         std::optional<TextureHandle> prepass_depth);

}  // namespace candela
