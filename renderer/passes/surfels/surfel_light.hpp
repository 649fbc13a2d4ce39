#pragma once

#include <optional>

#include <candela/graph/frame_graph.hpp>
#include "renderer/gpu/gpu.hpp"
#include "renderer/passes/lights/lights.hpp"
#include "renderer/passes/scene/bvh.hpp"
#include "renderer/passes/scene/scene_motion.hpp"
#include "renderer/passes/sky/sky_vpls.hpp"
#include "renderer/passes/surfels/surfels.hpp"
#include "renderer/passes/vpls/vpls.hpp"

namespace candela {

/// Visibility between surfels.
struct SurfelVisibility {
    Surfels surfels;
    /// Half floats, two per word, `surfel_columns` per surfel; 0 if hidden. Layout:
    /// shaders/surfels/surfel.glsl.
    BufferHandle<std::uint32_t> form_factors;
    /// By surfel: scale of its form factors, and the cosine-weighted share of its hemisphere in which no
    /// reflecting surface is visible.
    BufferHandle<glm::vec2> rows;
};

/// How many surfels a surfel gathers from: at most MOST_COLUMNS. If there are more, every n-th represents n
/// surfels.
struct SurfelColumns {
    std::uint32_t count = 0;   ///< columns per surfel; even
    std::uint32_t stride = 1;  ///< n: at least 1
};
[[nodiscard]] SurfelColumns surfel_columns(std::uint32_t surfels);

/// Adds node `surfel-visibility` (compute). It finds the form factors between surfels, with one ray for each
/// pair of surfels that face each other; the form factor is that of a disc (shaders/vpls/disc.glsl). Factors
/// are then scaled, so that those of a surfel add up to the share of its hemisphere in which rays hit
/// reflecting surfaces (Sinkhorn and Knopp, 1967: shaders/surfels/surfel_rows.comp). If something moves, only
/// rays that pass through the changed boxes are traced again. Depends on surfels, BVH and motion, and on its
/// own last result.
[[nodiscard]] SurfelVisibility add_surfel_visibility(FrameGraph& graph, Gpu& gpu, const Tracing& tracing,
                                                     const Surfels& surfels, ValueHandle<SceneMotion> motion);

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
};

/// Adds two nodes. `surfel-light` (compute): light of the real lights at each point of the surfels' cells,
/// with one shadow ray per point and light, light that the points emit, and light of the surfels that emit
/// and of the sky, shared among the points of a cell. `surfel-bounce` (compute):
/// surfels gather the light that other surfels reflect, bounce by bounce (Jacobi iteration of the radiosity
/// equation; Goral et al., "Modeling the Interaction of Light Between Diffuse Surfaces", 1984), up to
/// `bounces` or until less than 0.1 % of the first reflected light is left; then they are written as VPLs.
/// They depend on surfels, visibility, lights, sky and BVH. Returns LitSurfels.
[[nodiscard]] Vpls add_surfel_light(FrameGraph& graph, Gpu& gpu, const Tracing& tracing,
                                    const SurfelVisibility& visibility, const SurfelSources& sources,
                                    std::uint32_t bounces, ShownLight shown);

}  // namespace candela
