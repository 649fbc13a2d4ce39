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
    std::optional<LightLists> lists;  ///< none: every surface visits every light
    Show show = Show::total;
    float geometry_bound = 1.0F;  ///< see `vpl_radius2`
};

/// Squared radius, in m², of the disc that a VPL stands for. N VPLs share the area A of the scene's surfaces,
/// so each is a disc of A/N: R² = A / (π N), and its geometry term is at most 1/R², where a form factor of 1
/// would be. `bound` scales that bound: at infinity the VPL is a point. The radius shrinks as N grows, and
/// the energy that it costs vanishes.
[[nodiscard]] float vpl_radius2(float bound, std::uint32_t vpl_count, float area);

/// Words to define in shaders that include lighting.glsl.
[[nodiscard]] std::vector<std::string> lighting_variant(const Lighting& lighting);

/// For a pass that shades: declares its reads, and binds them and sets its uniforms when it runs.
void read_lighting(Pass& pass, const Lighting& lighting);
void bind_lighting(const Gpu& gpu, Execution& run, const gl::Program& program, const Lighting& lighting);

}  // namespace candela
