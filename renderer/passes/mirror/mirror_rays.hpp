#pragma once

#include <cstdint>
#include <optional>

#include <candela/graph/frame_graph.hpp>
#include "renderer/gpu/gpu.hpp"
#include "renderer/passes/indirect/vpl_light.hpp"
#include "renderer/passes/scene/bvh.hpp"
#include "renderer/passes/sky/sky.hpp"
#include "renderer/passes/sky/sky_tree.hpp"
#include "renderer/passes/surfaces/surfaces.hpp"
#include "renderer/passes/view/view.hpp"

namespace candela {

struct MirroredSky {
    Sky sky;
    TextureHandle picture;  ///< see add_sky_picture
    SkyTreeData tree;
};

/// What is to be seen in mirrors.
struct MirroredSources {
    bool emitters = false;
    bool bumpy = false;  ///< the scene's surfaces may be, whatever those of the view are
    /// Whose emitting surfels light rough surfaces; none: rays find what emits light.
    std::optional<VplLight> vpls{};
    std::optional<MirroredSky> sky{};
};

/// What glossy surfaces show in the mirror direction. Textures of the view's size.
struct MirroredSurfaces {
    /// As passes that shade read them: `depth` is rgba32f, the width of a pixel there in metres, 0 where
    /// there is no surface, and the position; `normal` is rgba32f, the face normal and the unit direction
    /// towards the glossy surface, octahedral. They have all parts of glossy surfaces, and are bumpy if the
    /// scene is. Roughness and metalness are the means over their texture; there is no occlusion. The alpha
    /// of the albedo is the radiance of an emitter that the ray was sent to, negative if it did not arrive, 0
    /// if to none.
    Surfaces surfaces;
    /// rgba32f: radiance that they emit, or of the sky; and the density of the ray's direction in 1/sr, 0
    /// where there is no ray.
    TextureHandle source;
    std::optional<ValueHandle<std::uint32_t>> round;  ///< of add_mirror_rays
};

/// Adds node `mirror-rays` (raster): one ray from each pixel of a glossy surface, in a random direction that
/// it reflects to the viewer, or to a surfel that emits light or a bright part of the sky, for surfaces that
/// are smooth enough (share_of_rays of gloss.glsl). Depends on the surfaces with their material, the scene's
/// triangles and materials, the sources and the view. `round`: another value gives other directions. None:
/// always the same.
[[nodiscard]] MirroredSurfaces add_mirror_rays(FrameGraph& graph, Gpu& gpu, const Surfaces& surfaces,
                                               const Tracing& tracing, const MirroredSources& sources,
                                               const ViewData& view,
                                               std::optional<ValueHandle<std::uint32_t>> round);

/// Adds node `mirror-resolve` (raster): adds what glossy surfaces show in the mirror direction to `radiance`,
/// from the rays of a pixel and its neighbours. In rough ones, the light of emitting surfels is a sum, of
/// which the rays tell how much is hidden. `reflected`: rgba32f, radiance that the mirrored surfaces
/// reflect; none: only what they emit is shown. Returns the radiance, modified in place.
[[nodiscard]] TextureHandle add_mirror_resolve(FrameGraph& graph, Gpu& gpu, const Surfaces& surfaces,
                                               const MirroredSources& sources,
                                               const MirroredSurfaces& mirrored,
                                               std::optional<TextureHandle> reflected, const ViewData& view,
                                               TextureHandle radiance);

}  // namespace candela
