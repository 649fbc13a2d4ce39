#pragma once

#include <candela/graph/frame_graph.hpp>
#include "renderer/passes/inspect/inspected.hpp"

namespace candela {

/// Adds node `inspect-range` (compute): the first two elements of the returned buffer are the range in which
/// the values of a resource with a picture are shown unless `settings` gives one, and the range of the
/// values; of each low, high and the number of texels whose values are infinite or no numbers. Depends on the
/// resource and on `settings`.
[[nodiscard]] BufferHandle<glm::vec4> add_inspect_range(FrameGraph& graph, Gpu& gpu,
                                                        const Inspected& inspected,
                                                        ValueHandle<Inspection> settings);

}  // namespace candela
