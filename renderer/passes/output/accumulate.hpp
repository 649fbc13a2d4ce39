#pragma once

#include <candela/graph/frame_graph.hpp>
#include "renderer/gpu/gpu.hpp"

namespace candela {

/// Adds node `accumulate` (raster): the mean radiance of the frames of a view that are averaged (see
/// Refined), kept from frame to frame and blended in place. With k frames before, the mean m becomes
/// m k / (k + 1) + x / (k + 1), where x is the frame's radiance; with none it is x bit for bit. Depends on
/// `radiance`, `averaged` and its own last result. Returns the mean, rgba32f, `size` pixels.
[[nodiscard]] TextureHandle add_accumulate(FrameGraph& graph, Gpu& gpu, TextureHandle radiance,
                                           ValueHandle<std::uint32_t> averaged, glm::uvec2 size);

}  // namespace candela
