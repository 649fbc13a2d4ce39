#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <tiny_gltf.h>
#include <nlohmann/json.hpp>

#include "engine/import/import_budget.hpp"
#include "engine/import/import_files.hpp"

namespace candela::gltf {

inline constexpr const char* lights_extension = "KHR_lights_punctual";
inline constexpr const char* emissive_strength_extension = "KHR_materials_emissive_strength";
inline constexpr const char* texture_transform_extension = "KHR_texture_transform";
inline constexpr const char* unlit_extension = "KHR_materials_unlit";
inline constexpr const char* environment_extension = "CANDELA_environment";
inline constexpr const char* light_extension = "CANDELA_light";
/// All extensions that are supported.
inline constexpr std::array<std::string_view, 6> supported_extensions{
    lights_extension, emissive_strength_extension, texture_transform_extension,
    unlit_extension,  environment_extension,       light_extension};

/// A part of a file, which it keeps in memory.
struct Buffer {
    Content content;
    Bytes bytes;
};

/// A checked glTF document with its buffers loaded. Nodes stay as JSON, of which there may be millions.
/// Images stay encoded: `model.images[i]` has a name and either `uri` or `bufferView`. Animations and skins
/// are left out.
struct Document {
    tinygltf::Model model;  ///< without buffers and nodes
    std::vector<Buffer> buffers;
    nlohmann::json nodes;  ///< array
    std::vector<std::string> warnings;
};

/// Parses and checks .gltf or .glb, distinguished by their first bytes, and loads the buffers. Throws
/// SceneError for malformed data and for required extensions that are not supported. The document refers to
/// `bytes`.
[[nodiscard]] Document read_document(Bytes bytes, ImportFiles& files, ImportBudget& budget);

}  // namespace candela::gltf
