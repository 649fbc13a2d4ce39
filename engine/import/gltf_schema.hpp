#pragma once

#include "engine/import/gltf_values.hpp"

namespace candela::gltf {

/// Checks the part of a glTF 2.0 document that the import reads: structure, types, array lengths, ranges of
/// numbers, and that every index refers to something that exists. What reads the document relies on it.
/// Throws SceneError, which names the first invalid member, such as `nodes[3].mesh is 7, but there are 2
/// meshes`.
void check_schema(const Json& document);

}  // namespace candela::gltf
