#pragma once

#include <optional>

#include <glm/vec2.hpp>

#include <candela/configuration.hpp>

#include <candela/graph/frame_graph.hpp>
#include <candela/view.hpp>
#include "renderer/gpu/gpu.hpp"

namespace candela {

/// How the values of a picture become those of the target.
struct Display {
    float exposure = 1.0F;           ///< factor on the values
    bool automatic = false;          ///< times that of find_exposure
    std::optional<ToneCurve> curve;  ///< none: linear
    bool encoded = false;            ///< sRGB encoding, by the shader
    bool opaque = false;             ///< alpha is 1; otherwise, that of the picture
    bool operator==(const Display&) const = default;
};
/// Radiance is exposed and goes through the curve; albedo is encoded only, and all else is as it is.
/// Without tone mapping, all are linear, and no exposure is automatic.
[[nodiscard]] Display display_of(const Configuration& configuration);

/// Adds node `tone-map` (raster): writes radiance, or what else the picture shows, to the host's target.
/// Depends on `radiance` and `target`, whose framebuffer is the object of `picture`, an
/// imported texture. Before it, adds node `exposure` if the exposure is automatic.
void add_tone_map(FrameGraph& graph, Gpu& gpu, TextureHandle radiance, ValueHandle<Target> target,
                  TextureHandle picture, const Display& display);

/// The same to a texture of the picture's size in pixels: rgba8 if the colours are encoded, else rgba32f.
[[nodiscard]] TextureHandle add_tone_map(FrameGraph& graph, Gpu& gpu, TextureHandle radiance, glm::uvec2 size,
                                         const Display& display);

/// Does the work of these nodes for pictures from elsewhere. The texture at UNIT_RADIANCE is drawn to the
/// target, with bilinear scaling if its size differs. Changes the draw framebuffer, the viewport and what is
/// bound at BINDING_EXPOSURE.
void tone_map(Gpu& gpu, const Target& target, const Display& display);

}  // namespace candela
