#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <tiny_gltf.h>

namespace candela::gltf {

/// Of the extensions that a file may require, the one that is read.
inline constexpr const char* lights_extension = "KHR_lights_punctual";

/// A checked glTF document with its buffers loaded (`model.buffers[i].data`). Images stay encoded:
/// `model.images[i]` has its name and either `uri` or `bufferView`. Animations and skins are left out.
struct Document {
    tinygltf::Model model;
    std::vector<std::string> warnings;
};

/// Reads a regular file whole. Throws SceneError that calls the file `called`.
[[nodiscard]] std::vector<unsigned char> read_file(const std::filesystem::path& path,
                                                   std::string_view called);

/// The bytes that a URI stands for: a base64 data URI, or a file relative to `base_directory` with its
/// special characters percent-encoded. Throws SceneError that names the URI.
[[nodiscard]] std::vector<unsigned char> read_uri(const std::string& uri,
                                                  const std::filesystem::path& base_directory);

/// Parses and checks .gltf or .glb, told apart by their first bytes, and loads the buffers. Required
/// extensions that are not supported, and anything malformed, throw SceneError.
[[nodiscard]] Document read_document(std::span<const unsigned char> bytes,
                                     const std::filesystem::path& base_directory);

}  // namespace candela::gltf
