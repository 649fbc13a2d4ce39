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
#include "renderer/passes/vpl_light.hpp"

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
    LightBuffers buffers;
    ShadowMaps shadows;
    std::optional<VplLight> vpls;  ///< that every surface asks; none: no indirect light, or gathered before
    std::optional<TextureHandle> indirect{};  ///< what was gathered before: see add_vpl_reconstruct
    std::optional<LightLists> lists;          ///< none: every surface visits every light
    Show show = Show::total;
};

/// Words to define in shaders that include lighting.glsl.
[[nodiscard]] std::vector<std::string> lighting_variant(const Lighting& lighting);

/// For a pass that shades: declares its reads, and binds them and sets its uniforms when it runs.
void read_lighting(Pass& pass, const Lighting& lighting);
void bind_lighting(const Gpu& gpu, Execution& run, const gl::Program& program, const Lighting& lighting);

}  // namespace candela
