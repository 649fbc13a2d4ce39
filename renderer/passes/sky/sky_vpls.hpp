#pragma once

#include <cstdint>
#include <optional>

#include <candela/graph/frame_graph.hpp>
#include "renderer/gpu/gpu.hpp"
#include "renderer/gpu/gpu_types.hpp"
#include "renderer/passes/sky/sky.hpp"
#include "renderer/passes/view/refinement.hpp"

namespace candela {

/// The sky's patches as VPLs: see place_sky. A uniform block: shaders/sky/sky_patch.glsl.
struct SkyPatches {
    BufferHandle<gpu::SkyPatch> patches;  ///< of MOST_SKY_PATCHES elements
    ValueHandle<std::uint32_t> count;
};

/// Adds node `sky-patches` (CPU, then upload): place_sky; with refinement also node `sky-sample` (CPU), as
/// every frames_a_surfel_set sets have another sample.
[[nodiscard]] SkyPatches add_sky_patches(FrameGraph& graph, const Gpu& gpu, const Sky& sky,
                                         std::optional<ValueHandle<Refinement>> refinement);

}  // namespace candela
