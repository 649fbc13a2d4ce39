#pragma once

#include <string>

#include "engine/graph/compile.hpp"

namespace candela {

/// For people and golden tests: passes in order with accesses and barriers, culled passes, resources with
/// lifetimes and objects. Stable for one declaration.
[[nodiscard]] std::string describe_text(const CompiledGraph& graph);
/// For Graphviz: passes are boxes, edges are the versions that one hands to another.
[[nodiscard]] std::string describe_dot(const CompiledGraph& graph);
/// The text's content as a JSON document.
[[nodiscard]] std::string describe_json(const CompiledGraph& graph);

}  // namespace candela
