#pragma once

#include <candela/graph/frame_graph.hpp>
#include "renderer/passes/inspect/inspected.hpp"

namespace candela {

/// Adds node `inspect-histogram` (compute): how many values of a resource with a picture are in each of
/// INSPECT_BINS equal parts of the range that is shown, for red, green and blue; only for the first of them
/// unless RGB is shown. Of large textures, one in several texels counts. Depends on the resource, the ranges
/// and `settings`.
[[nodiscard]] BufferHandle<std::uint32_t> add_inspect_histogram(FrameGraph& graph, Gpu& gpu,
                                                                const Inspected& inspected,
                                                                ValueHandle<Inspection> settings,
                                                                BufferHandle<glm::vec4> ranges);

}  // namespace candela
