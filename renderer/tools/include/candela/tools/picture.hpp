#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <candela/api.hpp>

namespace candela::tools {

/// A picture of linear RGB radiance. Pixel (x, y) is `pixels[y * size.x + x]`; row 0 is at the top.
struct Picture {
    glm::ivec2 size{0};
    std::vector<glm::vec3> pixels;
};

/// The same upside down: from the rows of OpenGL, which begin at the bottom, or to them.
[[nodiscard]] CANDELA_API Picture flipped(Picture picture);

/// Texels of a tone-mapped texture, the bottom row first, channels from 0 to 1, as write_png takes them.
[[nodiscard]] CANDELA_API std::vector<std::uint8_t> rgb_of_texels(glm::uvec2 size,
                                                                  std::span<const glm::vec4> texels);

// Writers keep every bit of a float: negative numbers, denormals, infinities and NaN are preserved. They
// write a whole file or none. All of them throw ToolError that names the file and the error.

/// `rgb` is tone-mapped and sRGB-encoded: 3 bytes per pixel, row 0 at the top, no padding.
CANDELA_API void write_png(const std::filesystem::path& path, glm::ivec2 size,
                           std::span<const std::uint8_t> rgb);

/// Channels R, G and B as 32-bit floats, losslessly compressed.
CANDELA_API void write_exr(const std::filesystem::path& path, const Picture& picture);

/// Portable float map: "PF", little-endian, rows from bottom to top.
CANDELA_API void write_pfm(const std::filesystem::path& path, const Picture& picture);

}  // namespace candela::tools
