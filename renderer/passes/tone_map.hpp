#pragma once

#include "engine/graph/frame_graph.hpp"
#include "renderer/gpu.hpp"

namespace candela {

struct ToneMapSettings {
    bool enabled = true;       ///< off: linear radiance goes out
    float exposure_ev = 0.0F;  ///< stops: radiance is multiplied by 2^exposure
    bool operator==(const ToneMapSettings&) const = default;
};

/// Node `tone-map`: brings radiance into the host's target through a filmic curve, sRGB-encoded. The target
/// stands for a framebuffer, and the object bound to it is that framebuffer's name.
void add_tone_map(FrameGraph& graph, Gpu& gpu, TextureHandle radiance, TextureHandle target, glm::uvec2 size,
                  const ToneMapSettings& settings);

/// What the node does, for images that come from elsewhere: `radiance` is a texture, drawn to the lower left
/// of `framebuffer`, scaled to `size` pixels if it has others.
void tone_map(const Gpu& gpu, const gl::Program& program, GLuint radiance, GLuint framebuffer,
              glm::uvec2 size, const ToneMapSettings& settings);
[[nodiscard]] const gl::Program& tone_map_program(Gpu& gpu);

}  // namespace candela
