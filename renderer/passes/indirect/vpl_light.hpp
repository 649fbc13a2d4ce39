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
    std::optional<VplMaps> maps{};  ///< if visibility is found by maps
    std::optional<Tracing> rays{};  ///< BVH for shadow rays: of all VPLs, or of those without a map
};

/// Iterations of loops that a VPL takes at most in vpl_light.glsl, in the mean of the kinds: see loop_parts.
[[nodiscard]] std::uint32_t iterations_a_vpl(const VplLight& light, const VplCounts& counts);
/// Most of them that an invocation can sum in one dispatch or draw, if few are surfels that emit light.
[[nodiscard]] std::uint32_t vpls_a_loop(const gl::Limits& limits, const VplLight& light);

/// Names to define in shaders that include vpl_light.glsl.
[[nodiscard]] std::vector<std::string> vpl_light_variant(const VplLight& light);

/// For a pass whose shader includes vpl_light.glsl.
void read_vpl_light(Pass& pass, const VplLight& light);

}  // namespace candela
