#pragma once

#include "engine/graph/frame_graph.hpp"
#include "renderer/gpu.hpp"
#include "renderer/passes/vpl_gather.hpp"

namespace candela {

struct IndirectLight {
    TextureHandle irradiance;  ///< rgba32f: π times the irradiance from all VPLs, in lux or W/m²
    /// Pixels that asked VPLs themselves, as few neighbours fit them: three numbers of work groups, the
    /// pixels' count, the pixels.
    BufferHandle<std::uint32_t> lacking;
};

/// From what every pixel has gathered, what it would have from all VPLs. Nodes `vpl-reconstruct-rows` and
/// `vpl-reconstruct` (compute): along rows and columns, each class of pixels counts once, interpolated
/// between the nearest of its pixels that lie on the same surface. Nodes `vpl-lacking` and `vpl-fill`
/// (compute): the pixels for which too few classes have such pixels are listed, and ask VPLs themselves.
[[nodiscard]] IndirectLight add_vpl_reconstruct(FrameGraph& graph, Gpu& gpu, const VisibleSurfaces& surfaces,
                                                const GatheredVpls& gathered, const VplLight& light,
                                                const FrameView& view, std::uint32_t interleave,
                                                glm::uvec2 size);

}  // namespace candela
