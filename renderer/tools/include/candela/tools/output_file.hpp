#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include <candela/api.hpp>

namespace candela::tools {

/// Writes the whole file or leaves the old one unchanged: the bytes go to a new file in the same folder,
/// which is then renamed. A pipe or a device is written to directly. Throws ToolError that names the
/// file and the error.
CANDELA_API void write_file(const std::filesystem::path& path, std::span<const std::byte> bytes);
CANDELA_API void write_text(const std::filesystem::path& path, std::string_view text);

/// The path's extension in lower case, which selects the output format: ".png", ".json", ...
[[nodiscard]] CANDELA_API std::string lower_extension(const std::filesystem::path& path);

}  // namespace candela::tools
