#pragma once

#include <memory>
#include <string>
#include <vector>

#include <candela/scene/components.hpp>
#include "engine/scene/gltf_document.hpp"

namespace candela::gltf {

/// The document's materials in its order, followed by the default material (white, single-sided). Textures
/// with the same image and wrapping share one Image; images that no base colour uses are not loaded. A
/// base-colour texture that cannot be used is left out, with an entry in the document's warnings. Throws
/// SceneError, which names the image or sampler and the problem.
[[nodiscard]] std::vector<std::shared_ptr<const Material>> read_materials(
    Document& document, const std::filesystem::path& base_directory);

}  // namespace candela::gltf
