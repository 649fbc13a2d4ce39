#pragma once

#include <nlohmann/json_fwd.hpp>

namespace candela::gltf {

/// Checks the part of a glTF 2.0 document that the import reads: structure, types, lengths of arrays, ranges
/// of numbers, and that every reference names something which exists. The parser behind the import takes what
/// is mistyped or negative for absent, so nothing later could tell. Throws SceneError that names the first
/// offending member, such as `nodes[3].mesh is 7, but there are 2 meshes`.
void check_schema(const nlohmann::json& document);

}  // namespace candela::gltf
