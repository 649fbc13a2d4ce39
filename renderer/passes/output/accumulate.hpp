#pragma once

#include <candela/graph/frame_graph.hpp>
#include "renderer/gpu.hpp"
#include "renderer/passes/view/refinement.hpp"

namespace candela {

/// Adds node `accumulate` (raster): the mean radiance of all frames since set 0 of the refinement, kept from
/// frame to frame. With set k the mean m becomes m + (x - m) / (k + 1), where x is the frame's radiance; with
/// set 0, and where the history is invalid, it is x bit for bit. Depends on `radiance` and `refinement`.
/// Returns the mean, rgba32f, `size` pixels.
[[nodiscard]] TextureHandle add_accumulate(FrameGraph& graph, Gpu& gpu, TextureHandle radiance,
                                           ValueHandle<Refinement> refinement, glm::uvec2 size);

}  // namespace candela
