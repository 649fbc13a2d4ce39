#pragma once

#include <candela/configuration.hpp>

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <candela/graph/frame_graph.hpp>
#include "renderer/gpu/gpu.hpp"
#include "renderer/passes/indirect/vpl_gather.hpp"
#include "renderer/passes/indirect/vpl_light.hpp"
#include "renderer/passes/lights/light_lists.hpp"
#include "renderer/passes/lights/lights.hpp"

namespace candela {

/// Everything that the evaluator in shaders/shading/lighting.glsl reads.
struct Lighting {
    SceneLights lights;
    std::optional<Tracing> shadow_rays{};  ///< none: lights have no shadows
    /// VPLs that are evaluated while shading; none: no indirect light, or it was gathered before.
    std::optional<VplLight> vpls{};
    std::optional<GatheredLight> indirect{};  ///< from all VPLs, gathered before
    std::optional<LightLists> lists{};        ///< none: every surface evaluates every light
    /// Most VPLs that a surface evaluates. If there are more, every k-th is evaluated and weighted by k.
    std::uint32_t most_vpls = std::numeric_limits<std::uint32_t>::max();
    Show show = Show::total;
    MaterialParts materials{};
    bool mirror_rays = false;  ///< what of that is not from lights is added later: add_mirror_resolve
};

[[nodiscard]] constexpr bool shows_direct(Show show) {
    return show == Show::total || show == Show::direct || show == Show::irradiance;
}
[[nodiscard]] constexpr bool shows_indirect(Show show) {
    return show == Show::total || show == Show::indirect || show == Show::irradiance;
}
/// Whether the sky and surfaces that emit light are seen themselves.
[[nodiscard]] constexpr bool shows_sources(Show show) {
    return show == Show::total || show == Show::direct;
}

/// Names to define in shaders that include lighting.glsl.
[[nodiscard]] std::vector<std::string> lighting_variant(const gl::Limits& limits, const Lighting& lighting);

/// Binds what is not a resource of the graph.
void bind_lighting(Gpu& gpu, const Lighting& lighting);

/// For a pass whose shader includes lighting.glsl.
void read_lighting(Pass& pass, const Lighting& lighting);

/// The dispatches or draws of a shading pass whose invocations shade `surfaces` surfaces each: see
/// loop_parts. Each adds the light of some entries of the light lists; the first one also adds the indirect
/// light. On a driver that stops long loops, there are so many that each light of a list may cast a ray.
[[nodiscard]] std::vector<gl::Uniforms> lighting_parts(const gl::Limits& limits, const Execution& run,
                                                       const Lighting& lighting, std::uint32_t surfaces);

}  // namespace candela
