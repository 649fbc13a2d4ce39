#pragma once

#include <optional>

#include <candela/graph/frame_graph.hpp>
#include "renderer/passes/inspect/inspected.hpp"

namespace candela {

/// Adds node `inspect-texel` (compute): the channels of a texel of a resource with a picture, as floats, and,
/// as the first component of a second element, metres where they are known. Has no content without a texel.
/// Depends on the resource, on `settings` and on `texel`.
[[nodiscard]] BufferHandle<glm::vec4> add_inspect_texel(FrameGraph& graph, Gpu& gpu,
                                                        const Inspected& inspected,
                                                        ValueHandle<Inspection> settings,
                                                        ValueHandle<std::optional<glm::uvec2>> texel);

}  // namespace candela
