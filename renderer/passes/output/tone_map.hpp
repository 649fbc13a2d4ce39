#pragma once

#include <optional>

#include <candela/configuration.hpp>

#include <candela/graph/frame_graph.hpp>
#include <candela/view.hpp>
#include "renderer/gpu/gpu.hpp"
#include "renderer/passes/surfaces/surfaces.hpp"
#include "renderer/passes/view/view.hpp"

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

/// Solid surfaces of a picture that is smaller than its target.
struct EnlargedSurfaces {
    TextureHandle depth;   ///< of the picture
    Surfaces in_target;    ///< with the resolution of the target: depth and normals
    ViewData target_view;  ///< of that size
};

/// Adds node `tone-map` (raster): writes radiance, or what else the picture shows, to the host's target.
/// Depends on `radiance` and `target`, whose framebuffer is the object of `picture`, an imported texture.
/// With `surfaces`, values are hardly interpolated across their edges: see enlarge.glsl.
/// Before it, adds node `exposure` if the exposure is automatic.
void add_tone_map(FrameGraph& graph, Gpu& gpu, TextureHandle radiance,
                  const std::optional<EnlargedSurfaces>& surfaces, ValueHandle<Target> target,
                  TextureHandle picture, const Display& display);

/// Does the work of these nodes for pictures from elsewhere. The texture at UNIT_RADIANCE is drawn to the
/// target, with bilinear scaling if its size differs. Changes the draw framebuffer, the viewport and what is
/// bound at BINDING_EXPOSURE.
void tone_map(Gpu& gpu, const Target& target, const Display& display);

}  // namespace candela
