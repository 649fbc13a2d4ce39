#pragma once

#include "engine/graph/frame_graph.hpp"
#include "renderer/gpu.hpp"
#include "renderer/passes/gbuffer.hpp"
#include "renderer/passes/lighting.hpp"
#include "renderer/passes/view.hpp"

namespace candela {

/// Node `deferred`: shades the G-buffer in one dispatch over all lights. Gives radiance, rgba32f.
[[nodiscard]] TextureHandle add_deferred(FrameGraph& graph, Gpu& gpu, const Gbuffer& gbuffer,
                                         const Lighting& lighting, const FrameView& view, glm::uvec2 size);

}  // namespace candela
