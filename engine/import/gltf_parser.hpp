#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/import/gltf_model.hpp"
#include "engine/json/json.hpp"

// TinyGLTF behind types of ours: its header takes seconds to compile.

namespace candela::gltf {

/// Bytes that `parse_model` needs for a checked document, a multiple of those of the shortest JSON for it.
[[nodiscard]] std::uint64_t parsing_memory(const Json& document);

/// What TinyGLTF reads of a checked document (see check_schema): all but buffers, images, nodes, animations
/// and skins. Throws SceneError if it refuses the document.
[[nodiscard]] Model parse_model(Json document);

/// The bytes of a base64 data URI; none if it is empty or of an unknown kind.
[[nodiscard]] std::optional<std::vector<unsigned char>> decode_data_uri(const std::string& uri);

}  // namespace candela::gltf
