#pragma once

#include <string>

#include <candela/api.hpp>
#include <candela/graph/compile.hpp>

namespace candela {

/// A listing for readers and golden tests: the passes in execution order with accesses and barriers, the
/// culled passes, and the resources with lifetimes (first and last position) and object numbers. The same
/// declaration always gives the same text.
[[nodiscard]] CANDELA_API std::string describe_text(const CompiledGraph& graph);
/// Graphviz source. Passes are boxes, rounded if they use neither textures nor buffers. Two passes have one
/// edge, with the names of all resources that one writes and the other uses, and a dashed one for histories.
[[nodiscard]] CANDELA_API std::string describe_dot(const CompiledGraph& graph);
/// The content of describe_text as a JSON document. The storage of a resource is also given by fields: its
/// kind; of a texture format, shape, size, layers and mips; of a buffer count and stride in bytes.
[[nodiscard]] CANDELA_API std::string describe_json(const CompiledGraph& graph);

}  // namespace candela
