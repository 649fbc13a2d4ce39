#pragma once

#include <candela/configuration.hpp>

#include <candela/graph/frame_graph.hpp>
#include "renderer/gpu.hpp"

namespace candela {

/// Adds node `tone-map` (raster): writes radiance to the host's target through a filmic curve (Narkowicz,
/// "ACES Filmic Tone Mapping Curve", 2015), sRGB-encoded by the shader, alpha 1. `target` is an imported
/// texture whose object is the GL name of a framebuffer of `size` pixels. Depends on `radiance`.
void add_tone_map(FrameGraph& graph, Gpu& gpu, TextureHandle radiance, TextureHandle target, glm::uvec2 size,
                  const ToneMapSettings& settings);

/// Does the work of the node, also for pictures from elsewhere. The texture at UNIT_RADIANCE is drawn to the
/// lower left `size` pixels of `framebuffer`, with bilinear scaling if its size differs. Changes the draw
/// framebuffer and the viewport.
void draw_tone_mapped(const Gpu& gpu, const gl::Program& program, GLuint framebuffer, glm::uvec2 size,
                      const ToneMapSettings& settings);
[[nodiscard]] const gl::Program& tone_map_program(Gpu& gpu);

}  // namespace candela
