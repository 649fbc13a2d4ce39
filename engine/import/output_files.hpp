#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <system_error>
#include <vector>

namespace candela {

struct OutputFile {
    std::filesystem::path path;
    std::vector<std::byte> bytes;
};

/// Writes the bytes to the file, whose content they replace, or to a pipe or a device.
[[nodiscard]] std::error_code write_bytes(const std::filesystem::path& path,
                                          std::span<const std::byte> bytes);

/// Writes all files or leaves all old ones as they are: the bytes go to new files in the same folders, which
/// are then renamed, in the order of the list. Throws SceneError, which names the file and the error. Once
/// all bytes are on the disk, renaming fails only where a file must not be replaced; those before it in the
/// list have been replaced then.
void write_files(std::span<const OutputFile> files);

}  // namespace candela
