#pragma once

#include <optional>
#include <string>

#include <candela/scene/components.hpp>
#include "engine/import/gltf_document.hpp"

namespace candela::gltf {

struct NamedEnvironment {
    std::string name;
    Environment environment;
};

/// The environment of the default scene: its extension CANDELA_environment, with members `name` (default
/// "environment"), `radiance` (three numbers; default 1), `uri` or `bufferView` (a picture, see
/// load_sky_picture; default none) and `rotation` (radians; default 0). Throws SceneError if the picture
/// cannot be read.
[[nodiscard]] std::optional<NamedEnvironment> read_environment(const Document& document, ImportFiles& files,
                                                               ImportBudget& budget);

}  // namespace candela::gltf
