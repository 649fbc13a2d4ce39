#pragma once

#include <optional>

#include <candela/graph/frame_graph.hpp>
#include "renderer/gpu/gpu.hpp"
#include "renderer/passes/lights/lights.hpp"
#include "renderer/passes/scene/bvh.hpp"
#include "renderer/passes/sky/sky_vpls.hpp"
#include "renderer/passes/surfels/surfel_visibility.hpp"
#include "renderer/passes/vpls/vpls.hpp"

namespace candela {

/// Which light the VPLs of surfels show. Surfels gather all light in any case.
struct ShownLight {
    bool emitted = true;
    bool reflected = true;
    bool operator==(const ShownLight&) const = default;
};

/// Where the light of surfels comes from.
struct SurfelSources {
    SceneLights lights;
    bool emitters = false;          ///< some surfaces emit light
    std::optional<SkyPatches> sky;  ///< none: the world has no sky
    bool balanced = false;          ///< LitSurfels::balanced
};

/// Adds two nodes. `surfel-light` (compute): light of the real lights at each point of the surfels' cells,
/// with a shadow ray per point and light (several for directional ones), light that the points emit, and
/// light of the surfels that emit and of the sky, shared among the points of a cell. `surfel-bounce`
/// (compute): surfels gather the light that other surfels reflect, bounce by bounce (Jacobi iteration of the
/// radiosity equation; Goral et al., "Modeling the Interaction of Light Between Diffuse Surfaces", 1984), up
/// to `bounces` or until a bounce adds less than 0.02 % to the light of each; then they are written as VPLs.
/// With `all_bounces`, the equation is solved in fewer steps (shaders/README.md, "Steps of bounces"). If
/// `sources.balanced`, the light of the VPLs is that above a mean, which is written behind them ("Shared
/// items"). They depend on surfels, visibility, lights, sky and BVH. Returns LitSurfels.
[[nodiscard]] Vpls add_surfel_light(FrameGraph& graph, Gpu& gpu, const Tracing& tracing,
                                    const SurfelVisibility& visibility, const SurfelSources& sources,
                                    std::uint32_t bounces, ShownLight shown);

}  // namespace candela
