#pragma once

#include <filesystem>

#include <candela/tools/picture.hpp>

namespace candela::sandbox {

// Readers of the pictures that the app writes, for tests and the study. They keep every bit of a float, and
// throw std::runtime_error that names the file and the error.

/// Reads channels R, G and B of a scan-line or tiled OpenEXR file with half or full floats.
[[nodiscard]] tools::Picture read_exr(const std::filesystem::path& path);

/// Reads a portable float map in colour ("PF") or grey ("Pf"; all channels get its value), little- or
/// big-endian. Only the sign of the header's scale is used, for the byte order.
[[nodiscard]] tools::Picture read_pfm(const std::filesystem::path& path);

}  // namespace candela::sandbox
