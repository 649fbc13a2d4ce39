#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <tiny_gltf.h>

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

/// A checked glTF document with its buffers loaded (`model.buffers[i].data`). Images stay encoded:
/// `model.images[i]` has a name and either `uri` or `bufferView`. Animations and skins are left out.
struct Document {
    tinygltf::Model model;
    std::vector<bool> node_has_name;  ///< per node: whether the file names it, if only with an empty name
    std::vector<std::string> warnings;
};

using Bytes = std::span<const unsigned char>;

/// Whether a file of these bytes begins with `prefix`, which tells what kind of file it is.
[[nodiscard]] bool starts_with(Bytes bytes, std::string_view prefix);

/// Reads a whole regular file. Throws SceneError, which names the file as `called`.
[[nodiscard]] std::vector<unsigned char> read_file(const std::filesystem::path& path,
                                                   std::string_view called);

/// The bytes behind a URI: a base64 data URI, or a percent-encoded file path relative to `base_directory`.
/// Throws SceneError, which names the URI.
[[nodiscard]] std::vector<unsigned char> read_uri(const std::string& uri,
                                                  const std::filesystem::path& base_directory);

/// Parses and checks .gltf or .glb, distinguished by their first bytes, and loads the buffers. Throws
/// SceneError for malformed data and for required extensions that are not supported.
[[nodiscard]] Document read_document(Bytes bytes, const std::filesystem::path& base_directory);

}  // namespace candela::gltf
