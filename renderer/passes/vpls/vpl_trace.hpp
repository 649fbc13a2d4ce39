#pragma once

#include <cstdint>

#include <candela/graph/frame_graph.hpp>
#include "renderer/gpu/gpu.hpp"
#include "renderer/passes/scene/bvh.hpp"
#include "renderer/passes/vpls/vpls.hpp"

namespace candela {

/// Square of the distance R within which the light of a VPL on a path hardly increases any more, in m²:
/// shaders/indirect/vpl_light.glsl. N VPLs share the area A (m²) of the scene's surfaces, and R is the
/// diameter of a disc of area A/N: R² = 4 A / (π N). This choice gave the least error in the Cornell box with
/// visibility of VPLs (tests/study). The geometry term is at most 4/3 of 1/R². `bound` multiplies 1/R²; at
/// infinity the VPL is a point. As N grows, R and the energy that the bound removes tend to 0.
[[nodiscard]] float vpl_radius2(float bound, std::uint32_t vpl_count, float area);

/// Adds node `vpl-trace` (compute): traces the light paths through the BVH, places a VPL at every bounce
/// (Keller, "Instant Radiosity", 1997), and finds the edges of the surfaces that the VPLs lie on
/// (shaders/vpls/vpl_edges.comp). `bound`: see vpl_radius2. Depends on the plan, the BVH and the lights.
/// Returns TracedVpls.
[[nodiscard]] Vpls add_vpl_trace(FrameGraph& graph, Gpu& gpu, const Tracing& tracing,
                                 ValueHandle<PathPlan> plan, BufferHandle<gpu::Light> lights, float bound);

}  // namespace candela
