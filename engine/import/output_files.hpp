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

/// Opens the file as fopen does in this mode and writes the bytes.
[[nodiscard]] std::error_code write_bytes(const std::filesystem::path& path, const char* mode,
                                          std::span<const std::byte> bytes);

/// Writes all files or leaves all old ones as they are: the bytes go to new files in the same folders, which
/// are then renamed, in the order of the list. Throws SceneError, which names the file and the error. Once
/// all bytes are on the disk, renaming fails only where a file must not be replaced; those before it in the
/// list have been replaced then.
void write_files(std::span<const OutputFile> files);

}  // namespace candela
