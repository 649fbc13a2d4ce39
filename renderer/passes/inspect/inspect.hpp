#pragma once

#include <candela/graph/frame_graph.hpp>
#include "renderer/passes/inspect/inspected.hpp"

namespace candela {

/// Adds node `inspect` (compute): a picture of what `settings` selects of a resource, with the first of
/// `ranges` unless the settings give a range. Values that are infinite or no numbers are magenta. Depends on
/// the resource, the ranges and `settings`. Returns a flat texture of rgba8, with colours for the display.
[[nodiscard]] TextureHandle add_inspect(FrameGraph& graph, Gpu& gpu, const Inspected& inspected,
                                        ValueHandle<Inspection> settings, BufferHandle<glm::vec4> ranges);

}  // namespace candela
