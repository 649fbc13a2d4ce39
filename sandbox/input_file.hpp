#pragma once

#include <filesystem>
#include <string>

namespace candela::sandbox {

/// The whole file. Throws std::runtime_error that names it and the fault.
[[nodiscard]] std::string read_file(const std::filesystem::path& path);

}  // namespace candela::sandbox
