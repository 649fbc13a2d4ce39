#pragma once

#include <vector>

#include <glm/vec4.hpp>

#include <candela/graph/frame_graph.hpp>
#include <candela/receiver.hpp>
#include "renderer/gpu/gpu.hpp"
#include "renderer/passes/shading/lighting.hpp"

namespace candela {

/// Irradiance at each of a host's receivers, in lux or W/m².
using ReceivedLight = BufferHandle<glm::vec4>;

/// Adds nodes `receivers` (CPU, then upload) and `receiver-light` (compute). `lighting` has no light lists,
/// and its indirect light is that of VPLs.
[[nodiscard]] ReceivedLight add_receivers(FrameGraph& graph, Gpu& gpu,
                                          ValueHandle<std::vector<Receiver>> receivers,
                                          const Lighting& lighting);

}  // namespace candela
