#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace candela::sandbox {

/// A picture of linear RGB radiance. Pixel (x, y) is `pixels[y * size.x + x]`; row 0 is at the top.
struct Picture {
    glm::ivec2 size{0};
    std::vector<glm::vec3> pixels;
};

/// The same upside down: from the rows of OpenGL, which begin at the bottom, or to them.
[[nodiscard]] Picture flipped(Picture picture);

// Readers and writers keep every bit of a float: negative numbers, denormals, infinities and NaN are
// preserved. Writers write a whole file or none. All of them throw std::runtime_error that names the file and
// the error.

/// `rgb` is tone-mapped and sRGB-encoded: 3 bytes per pixel, row 0 at the top, no padding.
void write_png(const std::filesystem::path& path, glm::ivec2 size, std::span<const std::uint8_t> rgb);

/// Channels R, G and B as 32-bit floats, losslessly compressed.
void write_exr(const std::filesystem::path& path, const Picture& picture);

/// Portable float map: "PF", little-endian, rows from bottom to top.
void write_pfm(const std::filesystem::path& path, const Picture& picture);
/// The same in grey ("Pf"): `values` has one value per pixel, row 0 at the top.
void write_grey_pfm(const std::filesystem::path& path, glm::ivec2 size, std::span<const float> values);

/// Reads channels R, G and B of a scan-line or tiled OpenEXR file with half or full floats.
[[nodiscard]] Picture read_exr(const std::filesystem::path& path);

/// Reads a portable float map in colour ("PF") or grey ("Pf"; all channels get its value), little- or
/// big-endian. Only the sign of the header's scale is used, for the byte order.
[[nodiscard]] Picture read_pfm(const std::filesystem::path& path);

}  // namespace candela::sandbox
