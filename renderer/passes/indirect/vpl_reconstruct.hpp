#pragma once

#include <candela/graph/frame_graph.hpp>
#include "renderer/gpu/gpu.hpp"
#include "renderer/passes/indirect/vpl_gather.hpp"

namespace candela {

/// Indirect light of every pixel, after reconstruction.
struct IndirectLight {
    GatheredLight light;  ///< from all VPLs
    /// Pixels that evaluated additional VPLs, because too few neighbours lie on the same surface. Words 0 to
    /// 2: work groups of an indirect dispatch; 3: number of pixels; from 4 on: pixels, x in the lower half
    /// word, y in the upper.
    BufferHandle<std::uint32_t> fill_list;
};

/// The same without what fills pixels for which too few classes were found: they have the light of those
/// alone. For rays, whose ends are scattered, and whose light is averaged.
[[nodiscard]] GatheredLight add_rough_reconstruct(FrameGraph& graph, Gpu& gpu, const Surfaces& surfaces,
                                                  const GatheredVpls& gathered, const ViewData& view);

/// Estimates the light of all VPLs at every pixel from what the pixels have gathered from their shares. Adds
/// nodes `vpl-reconstruct-rows` and `vpl-reconstruct` (compute): separable filters along rows, then along
/// columns. Each class of pixels counts once, interpolated linearly between its nearest pixels that lie on
/// the same surface. Adds nodes `vpl-fill-list` and `vpl-fill` (compute): pixels for which too few classes
/// have such pixels are listed, and sum one in `filled_from` (2 or 4) of the VPLs themselves. They
/// depend on depth and normal of the surfaces, the gathered light, the VPLs and the view.
[[nodiscard]] IndirectLight add_vpl_reconstruct(FrameGraph& graph, Gpu& gpu, const Surfaces& surfaces,
                                                const GatheredVpls& gathered, const VplLight& light,
                                                const ViewData& view, std::uint32_t filled_from);

}  // namespace candela
