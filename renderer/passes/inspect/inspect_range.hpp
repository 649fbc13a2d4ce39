#pragma once

#include <candela/graph/frame_graph.hpp>
#include "renderer/passes/inspect/inspected.hpp"

namespace candela {

/// Adds node `inspect-range` (compute): the range of the values that are shown of a resource with a picture,
/// low and high, as the first element of the returned buffer. Has no content while `settings` gives the
/// range. Depends on the resource and on `settings`.
[[nodiscard]] BufferHandle<glm::vec2> add_inspect_range(FrameGraph& graph, Gpu& gpu,
                                                        const Inspected& inspected,
                                                        ValueHandle<Inspection> settings);

}  // namespace candela
