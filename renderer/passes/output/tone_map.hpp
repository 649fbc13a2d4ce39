#pragma once

#include <candela/configuration.hpp>

#include <candela/graph/frame_graph.hpp>
#include <candela/view.hpp>
#include "renderer/gpu.hpp"

namespace candela {

/// Adds node `tone-map` (raster): writes radiance to the host's target through a filmic curve (Narkowicz,
/// "ACES Filmic Tone Mapping Curve", 2015), sRGB-encoded by the shader, alpha 1; or as it is, times
/// the exposure. Depends on `radiance` and `target`, whose framebuffer is the object of `picture`, an
/// imported texture.
void add_tone_map(FrameGraph& graph, Gpu& gpu, TextureHandle radiance, ValueHandle<Target> target,
                  TextureHandle picture, const ToneMapSettings& settings);

/// Does the work of the node, also for pictures from elsewhere. The texture at UNIT_RADIANCE is drawn to the
/// target, with bilinear scaling if its size differs. Changes the draw framebuffer and the viewport.
void draw_tone_mapped(const Gpu& gpu, const gl::Program& program, const Target& target,
                      const ToneMapSettings& settings);
[[nodiscard]] const gl::Program& tone_map_program(Gpu& gpu);

}  // namespace candela
