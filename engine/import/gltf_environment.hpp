#pragma once

#include <filesystem>
#include <optional>

#include <candela/scene/components.hpp>
#include "engine/import/gltf_document.hpp"

namespace candela::gltf {

/// The environment of the default scene: its extension CANDELA_environment, with members `radiance` (three
/// numbers; default 1), `uri` (a picture, see load_sky_picture; default none) and `rotation` (radians;
/// default 0). Throws SceneError if the picture cannot be read.
[[nodiscard]] std::optional<Environment> read_environment(const tinygltf::Model& model,
                                                          const std::filesystem::path& base_directory);

}  // namespace candela::gltf
