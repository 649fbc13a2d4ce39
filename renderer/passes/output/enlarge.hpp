#pragma once

#include <candela/graph/frame_graph.hpp>
#include <candela/view.hpp>
#include "renderer/gpu/gpu.hpp"
#include "renderer/passes/surfaces/surfaces.hpp"
#include "renderer/passes/view/view.hpp"

namespace candela {

/// A picture that has fewer pixels than its target, in display colours, and the surfaces that it shows.
struct SmallPicture {
    TextureHandle colours;
    TextureHandle depth;
    Surfaces in_target;    ///< depth and normals with the resolution of the target
    ViewData target_view;  ///< of that size
};

/// Adds node `enlarge` (raster): draws a picture to the host's target, along the edges of the surfaces there.
/// Depends on all of them and on `target`, whose framebuffer is the object of `out`, an imported texture.
void add_enlarge(FrameGraph& graph, Gpu& gpu, const SmallPicture& picture, ValueHandle<Target> target,
                 TextureHandle out);

}  // namespace candela
