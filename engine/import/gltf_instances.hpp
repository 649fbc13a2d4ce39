#pragma once

#include <cstddef>
#include <vector>

#include <candela/scene/components.hpp>
#include "engine/import/gltf_document.hpp"

namespace candela::gltf {

/// The number of a node's instances (EXT_mesh_gpu_instancing); 0 without the extension. Throws SceneError.
[[nodiscard]] std::size_t count_instances(const Document& document, const Json& node);

/// The instances' transforms relative to the node, `count` of them. The caller has counted their memory.
/// Throws SceneError, which names the instance or accessor.
[[nodiscard]] std::vector<Transform> read_instances(const Document& document, const Json& node,
                                                    std::size_t count);

}  // namespace candela::gltf
