#pragma once

#include <cstdint>
#include <vector>

#include "engine/graph/frame_graph.hpp"
#include "renderer/gpu.hpp"
#include "renderer/passes/depth_prepass.hpp"
#include "renderer/passes/view.hpp"
#include "renderer/passes/vpl_light.hpp"

namespace candela {

/// How many VPLs a pixel asks: with n, pixels fall into n × n classes by their place modulo n, each class
/// asks one n²-th of the VPLs, and a pixel takes from its neighbours what it has not asked. Names as in JSON,
/// on the command line and in the panel: auto, 1, 2, 4, 8.
enum class Interleave : std::uint8_t { automatic, one, two, four, eight };

/// The n that is meant for so many VPLs and a picture of so many pixels; `automatic` is the largest that
/// leaves each class eight VPLs, and of which the picture's height has sixty.
[[nodiscard]] std::uint32_t interleaving(Interleave interleave, std::uint32_t vpl_count, glm::uvec2 size);

/// The order in which VPLs are dealt: every stretch of it holds as many of each light and bounce as is in
/// proportion, and of these ones that follow each other in the light's sequence, which is spread evenly.
[[nodiscard]] std::vector<std::uint32_t> deal_vpls(const VplPlan& paths);

struct GatheredVpls {
    /// rgba32f: π times the irradiance, in lux or W/m² as the lights have it, that all VPLs would give if
    /// they were like those that the pixel asked; alpha 1 where there is a surface.
    TextureHandle irradiance;
    BufferHandle<std::uint32_t> order;  ///< `deal_vpls`
};

/// Node `vpl-deal` (CPU): the order of the VPLs. Node `vpl-gather` (compute): each pixel asks the VPLs of its
/// class's share. Wald et al., "Interactive Global Illumination using Fast Ray Tracing" (2002).
[[nodiscard]] GatheredVpls add_vpl_gather(FrameGraph& graph, Gpu& gpu, const VisibleSurfaces& surfaces,
                                          const VplLight& light, const FrameView& view,
                                          std::uint32_t interleave, glm::uvec2 size);

}  // namespace candela
