#pragma once

#include <filesystem>
#include <string>

namespace candela::sandbox {

/// Reads the whole file. Throws std::runtime_error that names the file and the error.
[[nodiscard]] std::string read_file(const std::filesystem::path& path);

}  // namespace candela::sandbox
