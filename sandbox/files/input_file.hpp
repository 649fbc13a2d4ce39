#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace candela::sandbox {

/// Bytes of the largest configuration or script that is read.
inline constexpr std::size_t largest_text = std::size_t{64} << 20U;

/// Reads a whole regular file of at most `largest_text` bytes. Throws std::runtime_error that names the file
/// and the error.
[[nodiscard]] std::string read_file(const std::filesystem::path& path);

}  // namespace candela::sandbox
