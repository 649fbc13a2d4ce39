#pragma once

#include <optional>
#include <string>
#include <vector>

#include <candela/graph/frame_graph.hpp>
#include "renderer/gpu/gpu.hpp"
#include "renderer/passes/scene/bvh.hpp"
#include "renderer/passes/vpls/vpl_constants.hpp"
#include "renderer/passes/vpls/vpls.hpp"

namespace candela {

/// Everything that shaders/indirect/vpl_light.glsl reads.
struct VplLight {
    Vpls vpls;
    VplCommon common;
    std::optional<TextureHandle> maps{};  ///< depth maps of the VPLs, if visibility is found by maps
    std::optional<Tracing> rays{};        ///< BVH for shadow rays: of all VPLs, or of those without a map
};

/// Most VPLs, or groups of surfels, that an invocation may sum in one dispatch or draw. Software drivers
/// silently stop all loops of an invocation after 65,535 iterations in total; a ray may take a thousand of
/// them.
[[nodiscard]] std::uint32_t max_vpls_per_invocation(const VplLight& light);

/// Names to define in shaders that include vpl_light.glsl.
[[nodiscard]] std::vector<std::string> vpl_light_variant(const VplLight& light);

/// For a pass whose shader includes vpl_light.glsl.
void read_vpl_light(Pass& pass, const VplLight& light);

}  // namespace candela
