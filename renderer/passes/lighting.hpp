#pragma once

#include <cstdint>
#include <limits>
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
    std::optional<VplLight> vpls{};  ///< that every surface asks; none: no indirect light, or gathered before
    std::optional<TextureHandle> indirect{};  ///< what was gathered before: see add_vpl_reconstruct
    std::optional<LightLists> lists{};        ///< none: every surface visits every light
    std::uint32_t most_vpls = std::numeric_limits<std::uint32_t>::max();  ///< a surface asks no more of them
    Show show = Show::total;
};

/// How many entries of its light list a surface may visit in one dispatch or draw: see `most_asked`. Four
/// surfaces share an invocation.
inline constexpr std::uint32_t most_visited = 8192;

/// Words to define in shaders that include lighting.glsl.
[[nodiscard]] std::vector<std::string> lighting_variant(const Lighting& lighting);

/// For a pass that shades: declares its reads, and binds them and sets its uniforms when it runs.
void read_lighting(Pass& pass, const Lighting& lighting);
void bind_lighting(const Gpu& gpu, Execution& run, const gl::Program& program, const Lighting& lighting);

/// In how many parts a pass dispatches or draws, each of which adds the light of `most_visited` lights.
[[nodiscard]] std::uint32_t lighting_parts(const Execution& run, const Lighting& lighting);
void begin_lighting_part(const gl::Program& program, std::uint32_t part);

}  // namespace candela
