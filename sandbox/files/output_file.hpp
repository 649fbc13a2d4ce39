#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace candela::sandbox {

/// Writes the whole file or leaves the old one unchanged: the bytes go to a new file in the same folder,
/// which is then renamed. A pipe or a device is written to directly. Throws std::runtime_error that names the
/// file and the error.
void write_file(const std::filesystem::path& path, std::span<const std::byte> bytes);
void write_text(const std::filesystem::path& path, std::string_view text);

/// The path's extension in lower case, which selects the output format: ".png", ".json", ...
[[nodiscard]] std::string lower_extension(const std::filesystem::path& path);

}  // namespace candela::sandbox
