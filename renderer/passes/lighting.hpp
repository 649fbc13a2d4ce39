#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/graph/frame_graph.hpp"
#include "renderer/gpu.hpp"
#include "renderer/passes/light_lists.hpp"
#include "renderer/passes/lights.hpp"
#include "renderer/passes/shadow_maps.hpp"
#include "renderer/passes/vpl_maps.hpp"
#include "renderer/passes/vpl_trace.hpp"

namespace candela {

/// Which part of the light goes into the picture.
enum class Show : std::uint8_t { total, direct, indirect };

/// The lights on the GPU, with the shadows that each has.
struct LightBuffers {
    BufferHandle<gpu::Light> lights;
    BufferHandle<gpu::Shadow> shadows;
};

/// Node `light-upload`.
[[nodiscard]] LightBuffers add_light_upload(FrameGraph& graph, const Gpu& gpu, ValueHandle<LightTable> lights,
                                            ValueHandle<ShadowPlan> plan);

/// All that the evaluator in shaders/lighting.glsl reads.
struct Lighting {
    ValueHandle<LightTable> lights;
    ValueHandle<SceneMetrics> metrics;
    LightBuffers buffers;
    ShadowMaps shadows;
    std::optional<Vpls> vpls;         ///< none: no indirect light
    std::optional<VplMaps> vpl_maps;  ///< where VPLs are looked up; none: not in maps
    std::optional<Tracing> vpl_rays;  ///< what rays to the VPLs are traced against; none: no rays
    std::optional<LightLists> lists;  ///< none: every surface visits every light
    Show show = Show::total;
    float geometry_bound = 1.0F;  ///< see `vpl_radius2`
};

/// Squared distance R², in m², from which on a VPL's light hardly grows: shaders/lighting.glsl. N VPLs share
/// the area A of the scene's surfaces; R is the diameter of a disc of A/N, R² = 4 A / (π N), the least error
/// in the Cornell box with shadows of VPLs (tests/study). The geometry term is at most 4/3 of 1/R², and
/// `bound` scales that; at infinity the VPL is a point. R shrinks as N grows, and the energy that it costs
/// vanishes.
[[nodiscard]] float vpl_radius2(float bound, std::uint32_t vpl_count, float area);

/// Words to define in shaders that include lighting.glsl.
[[nodiscard]] std::vector<std::string> lighting_variant(const Lighting& lighting);

/// For a pass that shades: declares its reads, and binds them and sets its uniforms when it runs.
void read_lighting(Pass& pass, const Lighting& lighting);
void bind_lighting(const Gpu& gpu, Execution& run, const gl::Program& program, const Lighting& lighting);

}  // namespace candela
