#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace candela::study {

/// 64-bit FNV-1a (Fowler, Noll and Vo) of the bytes, going on from an earlier state. It tells contents apart
/// that nobody made alike on purpose.
inline constexpr std::uint64_t fnv1a_basis = 0xcbf29ce484222325U;
[[nodiscard]] std::uint64_t fnv1a(std::string_view bytes, std::uint64_t state = fnv1a_basis);

/// 16 hexadecimal digits that stand for all that makes a glTF scene: the file's bytes, and those of the
/// buffers and images that it refers to. Where the files lie makes no difference. Throws SceneError that
/// names the file.
[[nodiscard]] std::string scene_hash(const std::filesystem::path& scene);

}  // namespace candela::study
