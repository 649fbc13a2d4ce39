#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/graph/frame_graph.hpp"
#include "renderer/gpu.hpp"
#include "renderer/passes/bvh.hpp"
#include "renderer/passes/vpl_constants.hpp"
#include "renderer/passes/vpl_trace.hpp"

namespace candela {

/// All that shaders/vpl_light.glsl reads.
struct VplLight {
    Vpls vpls;
    VplCommon common;
    std::optional<TextureHandle> maps{};  ///< where VPLs are looked up; none: not in maps
    std::optional<Tracing> rays{};        ///< what rays to the VPLs are traced against; none: no rays
};

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
