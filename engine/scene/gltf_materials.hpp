#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/scene/components.hpp"
#include "engine/scene/gltf_document.hpp"

namespace candela::gltf {

/// The document's materials in its order, and after them the default one (white, single-sided). Textures that
/// agree in image and wrapping share one Image; images that no base colour uses are not loaded. What a
/// material asks for and does not get is added to the document's warnings. Throws SceneError that names the
/// image and the fault.
[[nodiscard]] std::vector<std::shared_ptr<const Material>> read_materials(
    Document& document, const std::filesystem::path& base_directory);

}  // namespace candela::gltf
