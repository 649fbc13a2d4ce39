#pragma once

#include "engine/graph/frame_graph.hpp"
#include "renderer/gpu.hpp"
#include "renderer/passes/refinement.hpp"

namespace candela {

/// Node `accumulate`: the mean radiance of all sets of VPLs since set 0, kept from frame to frame. With set k
/// the mean m becomes m + (x - m) / (k + 1), x being the frame's radiance; with set 0 it is x, bit for bit.
[[nodiscard]] TextureHandle add_accumulate(FrameGraph& graph, Gpu& gpu, TextureHandle radiance,
                                           ValueHandle<Refinement> refinement, glm::uvec2 size);

}  // namespace candela
