#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace candela::sandbox {

/// Writes the whole file or leaves what was there: the bytes go to a new file in the same folder, which then
/// takes the name. A path to a pipe or a device is written to as it stands. Throws std::runtime_error that
/// names the file and the fault.
void write_file(const std::filesystem::path& path, std::span<const std::byte> bytes);
void write_text(const std::filesystem::path& path, std::string_view text);

/// The path's extension in lower case, which says what goes into the file: ".png", ".json", ...
[[nodiscard]] std::string lower_extension(const std::filesystem::path& path);

}  // namespace candela::sandbox
