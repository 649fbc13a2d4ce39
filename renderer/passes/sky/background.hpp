#pragma once

#include <candela/graph/frame_graph.hpp>
#include "renderer/gpu/gpu.hpp"
#include "renderer/passes/sky/sky.hpp"
#include "renderer/passes/surfaces/surfaces.hpp"
#include "renderer/passes/view/view.hpp"

namespace candela {

/// Adds node `sky-picture` (upload): the picture of the sky, rgba16f; radiance above 65,504 is cut to it. A
/// sky without a picture has one white texel. Depends on the sky. For shaders/sky/sky_picture.glsl.
[[nodiscard]] TextureHandle add_sky_picture(FrameGraph& graph, Gpu& gpu, const Sky& sky);
/// Uniforms of shaders/sky/sky_picture.glsl.
[[nodiscard]] gl::Uniforms sky_uniforms(const Environment& environment);

/// Adds node `background` (raster): writes the radiance of the sky, alpha 0, where there is no surface.
/// Depends on the sky, its picture, view, the depth of the surfaces and `radiance`. Returns the radiance,
/// modified in place.
[[nodiscard]] TextureHandle add_background(FrameGraph& graph, Gpu& gpu, const Sky& sky, TextureHandle picture,
                                           const ViewData& view, const Surfaces& surfaces,
                                           TextureHandle radiance);

}  // namespace candela
