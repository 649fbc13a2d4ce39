#pragma once

#include <string>

#include <candela/api.hpp>
#include <candela/graph/compile.hpp>

namespace candela {

/// A listing for readers and golden tests: the passes in execution order with accesses and barriers, the
/// culled passes, and the resources with lifetimes (first and last position) and object numbers. The same
/// declaration always gives the same text.
[[nodiscard]] CANDELA_API std::string describe_text(const CompiledGraph& graph);
/// Graphviz source. Passes are boxes; an edge is a resource that one pass writes and another uses, dashed for
/// histories.
[[nodiscard]] CANDELA_API std::string describe_dot(const CompiledGraph& graph);
/// The content of describe_text as a JSON document.
[[nodiscard]] CANDELA_API std::string describe_json(const CompiledGraph& graph);

}  // namespace candela
