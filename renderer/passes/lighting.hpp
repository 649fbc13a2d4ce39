#pragma once

#include <cstdint>
#include <optional>

#include "engine/graph/frame_graph.hpp"
#include "renderer/gpu.hpp"
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
    std::optional<Vpls> vpls;  ///< none: no indirect light
    Show show = Show::total;
    float geometry_bound = 0.1F;  ///< see `bound_geometry_term`
};

/// Bound on a VPL's geometry term cos θ cos θ' / r², in 1/m². N VPLs stand for patches of A/N each, A being
/// the area of the scene's surfaces. Seen from anywhere, such a patch has a form factor of at most 1, and a
/// VPL stands for it with G/π · A/N; so G above π N / A is an artefact of the point. `factor` scales that
/// bound: 1 is the bound itself, infinity none. It rises with N, and the energy that it costs vanishes.
[[nodiscard]] float bound_geometry_term(float factor, std::uint32_t vpl_count, float area);

/// For a pass that shades: declares its reads, and binds them and sets its uniforms when it runs.
void read_lighting(Pass& pass, const Lighting& lighting);
void bind_lighting(const Gpu& gpu, Execution& run, const gl::Program& program, const Lighting& lighting);

}  // namespace candela
