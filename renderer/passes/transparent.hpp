#pragma once

#include "engine/graph/frame_graph.hpp"
#include "renderer/gpu.hpp"
#include "renderer/passes/forward.hpp"
#include "renderer/passes/lighting.hpp"
#include "renderer/passes/scene_upload.hpp"
#include "renderer/passes/view.hpp"

namespace candela {

/// Node `transparent`: draws the blended surfaces over what is there, in every shading path alike: radiance =
/// alpha · lit + (1 - alpha) · behind, where alpha is the base colour's and `lit` is what `forward` gives for
/// an opaque surface. They are hidden by what `surfaces.depth` holds and hide nothing themselves. Gives the
/// radiance on.
///
/// Drawables are drawn one after another, the farthest first, by the depth of their bounds' centre in view
/// space; those as far as each other in an order that does not change. Of a double-sided one the back faces
/// are drawn before the front faces. That is right for drawables that are convex and do not reach through
/// each other; the triangles of others are drawn in the mesh's order. Blended surfaces receive light, direct
/// and indirect, and shadows, but neither cast shadows nor place VPLs.
[[nodiscard]] TextureHandle add_transparent(FrameGraph& graph, Gpu& gpu, const SceneData& scene,
                                            const Lighting& lighting, const FrameView& view,
                                            const ShadedSurfaces& surfaces);

}  // namespace candela
