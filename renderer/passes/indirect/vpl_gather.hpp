#pragma once

#include <candela/configuration.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <candela/graph/frame_graph.hpp>
#include "renderer/gpu/gpu.hpp"
#include "renderer/passes/indirect/vpl_light.hpp"
#include "renderer/passes/surfaces/surfaces.hpp"
#include "renderer/passes/view/view.hpp"

namespace candela {

/// The factor n for `vpl_count` VPLs and a picture of `size` pixels. `automatic` gives the largest n of 8, 4,
/// 2, 1 with at least eight VPLs per class and a picture height of at least 60 · n pixels.
[[nodiscard]] std::uint32_t interleaving(Interleave interleave, std::uint32_t vpl_count, glm::uvec2 size);

/// The order of VPLs, as indices, of which each class of pixels takes a consecutive range as its share. Each
/// range contains VPLs of each light and bounce in proportion. Within these, they are consecutive points of
/// the light's low-discrepancy sequence, which are evenly distributed.
[[nodiscard]] std::vector<std::uint32_t> order_vpls(const PathPlan& paths);

/// The light that pixels have gathered from VPLs.
struct GatheredLight {
    TextureHandle irradiance;  ///< rgba32f: π times the irradiance; in lux or W/m², by the unit of the lights
    /// rgba32f: how it is distributed over directions, Gathered::flow of shaders/indirect/gathered.glsl. Only
    /// surfaces with shading normals need it.
    std::optional<TextureHandle> flow{};
};

/// Writes its textures, whose names start with `name`, to IMAGE_INDIRECT and IMAGE_INDIRECT_DIRECTION.
[[nodiscard]] GatheredLight write_gathered(FrameGraph& graph, Pass& pass, std::string_view name,
                                           glm::uvec2 size, bool directed);
/// Reads them at UNIT_INDIRECT and UNIT_INDIRECT_DIRECTION.
void read_gathered(Pass& pass, const GatheredLight& light);
/// Names to define in shaders that handle the light.
[[nodiscard]] std::vector<std::string> gathered_variant(const GatheredLight& light,
                                                        std::vector<std::string> others = {});

/// What each pixel has gathered from its share of the VPLs.
struct GatheredVpls {
    /// Estimate for all VPLs, extrapolated from the share of the pixel's class. Alpha of the irradiance is 1
    /// where there is a surface, else 0.
    GatheredLight light;
    BufferHandle<std::uint32_t> order;  ///< see add_vpl_order
    std::uint32_t interleave = 1;       ///< n
};

/// Adds node `vpl-order` (CPU, then upload): the order of VPLs on paths is that of order_vpls; surfels are
/// ordered so that each range contains surfels from all surfaces. Depends on the paths, or on the number of
/// VPLs.
[[nodiscard]] BufferHandle<std::uint32_t> add_vpl_order(FrameGraph& graph, const Gpu& gpu, const Vpls& vpls);

/// Adds node `vpl-gather` (compute): each pixel sums the light of the VPLs in the share of its class (Wald et
/// al., "Interactive Global Illumination using Fast Ray Tracing", 2002; Segovia et al., "Non-interleaved
/// Deferred Shading of Interleaved Sample Patterns", 2006). Depends on the VPLs, depth and normal of the
/// surfaces, and the view. `order`: of add_vpl_order. `interleave`: n. `directed`: with GatheredLight::flow.
[[nodiscard]] GatheredVpls add_vpl_gather(FrameGraph& graph, Gpu& gpu, const Surfaces& surfaces,
                                          const VplLight& light, BufferHandle<std::uint32_t> order,
                                          const ViewData& view, std::uint32_t interleave, bool directed);

}  // namespace candela
