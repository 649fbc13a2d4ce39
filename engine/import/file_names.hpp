#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace candela::gltf {

// In glTF files and in messages, the names of files are UTF-8. std::filesystem alone would take the encoding
// of the system, which on Windows may be another.

[[nodiscard]] inline std::filesystem::path path_of(std::string_view utf8) {
    return std::u8string(utf8.begin(), utf8.end());
}

[[nodiscard]] inline std::string utf8_of(const std::filesystem::path& path) {
    const std::u8string name = path.u8string();
    return {name.begin(), name.end()};
}

}  // namespace candela::gltf
