#pragma once

#include <memory>
#include <optional>

#include <candela/graph/frame_graph.hpp>
#include <candela/scene/components.hpp>
#include "renderer/gpu.hpp"
#include "renderer/gpu_types.hpp"
#include "renderer/passes/view/refinement.hpp"

namespace candela {

/// The world's sky on the CPU.
struct Sky {
    ValueHandle<Environment> environment;
    ValueHandle<std::shared_ptr<const SkyPicture>> picture;  ///< of the environment; changes less often
};

/// Adds node `sky` (CPU): reads the Environment.
[[nodiscard]] Sky add_sky(FrameGraph& graph);

/// The sky's patches in the form of VPLs: see place_sky.
struct SkyPatches {
    BufferHandle<gpu::Vpl> vpls;
    ValueHandle<std::uint32_t> count;
};

/// Adds nodes `sky-split` (CPU: split_sky, when the picture changes) and `sky-patches` (CPU, then upload:
/// place_sky; with refinement, another sample every frames_a_surfel_set sets).
[[nodiscard]] SkyPatches add_sky_patches(FrameGraph& graph, const Gpu& gpu, const Sky& sky,
                                         std::uint32_t count,
                                         std::optional<ValueHandle<Refinement>> refinement);

}  // namespace candela
