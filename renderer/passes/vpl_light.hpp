#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/graph/frame_graph.hpp"
#include "renderer/gpu.hpp"
#include "renderer/passes/bvh.hpp"
#include "renderer/passes/vpl_maps.hpp"
#include "renderer/passes/vpl_trace.hpp"

namespace candela {

/// All that shaders/vpl_light.glsl reads.
struct VplLight {
    Vpls vpls;
    ValueHandle<SceneMetrics> metrics;
    std::optional<VplMaps> maps{};  ///< where VPLs are looked up; none: not in maps
    std::optional<Tracing> rays{};  ///< what rays to the VPLs are traced against; none: no rays
    float geometry_bound = 1.0F;    ///< see `vpl_radius2`
};

/// Squared distance R², in m², from which on a VPL's light hardly grows: shaders/vpl_light.glsl. N VPLs share
/// the area A of the scene's surfaces; R is the diameter of a disc of A/N, R² = 4 A / (π N), the least error
/// in the Cornell box with shadows of VPLs (tests/study). The geometry term is at most 4/3 of 1/R², and
/// `bound` scales that; at infinity the VPL is a point. R shrinks as N grows, and the energy that it costs
/// vanishes.
[[nodiscard]] float vpl_radius2(float bound, std::uint32_t vpl_count, float area);

/// How many VPLs an invocation may ask in one dispatch. Software drivers end all loops of an invocation
/// together after 65,535 turns, without a word; a ray may take a thousand of them.
[[nodiscard]] std::uint32_t most_asked(const VplLight& light);

/// Words to define in shaders that include vpl_light.glsl.
[[nodiscard]] std::vector<std::string> vpl_light_variant(const VplLight& light);

/// For a pass whose shader includes it: declares its reads, and binds them and sets its uniforms when it
/// runs.
void read_vpl_light(Pass& pass, const VplLight& light);
void bind_vpl_light(const Gpu& gpu, Execution& run, const gl::Program& program, const VplLight& light);

}  // namespace candela
