#pragma once

#include <candela/graph/frame_graph.hpp>
#include "renderer/gpu/gpu.hpp"
#include "renderer/passes/scene/scene_upload.hpp"
#include "renderer/passes/shading/lighting.hpp"
#include "renderer/passes/surfaces/surfaces.hpp"
#include "renderer/passes/view/view.hpp"

namespace candela {

/// What blended surfaces may do besides reflecting light.
struct TransparentParts {
    bool emission = false;
    bool glass = false;  ///< let light through: Material::transmission
};

/// Adds node `transparent` (raster): draws the blended surfaces over the solid ones: radiance = alpha · lit +
/// (1 - alpha) · behind (Porter and Duff's "over" operator, 1984), where alpha is that of the base colour and
/// `lit` the radiance that `forward` gives for an opaque surface, and with `emission` what it emits. It is
/// the same in every shading path. Where alpha is that of an opaque or masked material, it is 1, or 0 in
/// holes. With `glass`, transmission · diffuse albedo · (1 - F) of `behind` is added to `lit`, F being the
/// share that the interface reflects, and only 1 - transmission of the diffuse part is lit. What glass
/// reflects in the mirror direction is not found by rays, as for all blended surfaces. Blended surfaces are
/// tested against the depth of the solid `surfaces` and do not write depth. Returns the radiance with them.
/// Depends on meshes, placement, materials, lighting, view, that depth and `radiance`.
///
/// Drawables are drawn one by one, from far to near by the view-space depth of the centre of their bounding
/// box; equal depths keep their order. The back faces of a double-sided drawable are drawn before its front
/// faces. That is correct for convex drawables that do not intersect; in others, triangles are drawn in the
/// order of the mesh. Blended surfaces receive direct and indirect light and shadows, but cast no shadows,
/// also no coloured ones, and place no VPLs; mirrors do not show them. On drivers that stop long loops, node
/// `transparent-parts` adds the light of what one draw cannot loop over: see lighting_parts.
[[nodiscard]] TextureHandle add_transparent(FrameGraph& graph, Gpu& gpu, const SceneData& scene,
                                            const Lighting& lighting, const ViewData& view,
                                            const Surfaces& surfaces, TextureHandle radiance,
                                            const TransparentParts& features);

}  // namespace candela
