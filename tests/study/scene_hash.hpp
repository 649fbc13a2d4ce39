#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace candela::study {

/// 64-bit FNV-1a (Fowler, Noll and Vo) of the bytes, continued from an earlier state. Not cryptographic:
/// collisions can be constructed.
inline constexpr std::uint64_t fnv1a_basis = 0xcbf29ce484222325U;
[[nodiscard]] std::uint64_t fnv1a(std::string_view bytes, std::uint64_t state = fnv1a_basis);

/// 16 hexadecimal digits that identify a glTF scene: from the bytes of the file and of the buffers and images
/// that it refers to. The location of the files does not matter. Throws SceneError that names the file.
[[nodiscard]] std::string scene_hash(const std::filesystem::path& scene);

}  // namespace candela::study
