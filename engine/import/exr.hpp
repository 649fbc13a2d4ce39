#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace candela {

/// An OpenEXR file with channels R, G and B as 32-bit floats, losslessly compressed. `texels`: width ×
/// height, rows top to bottom. Throws SceneError, whose message does not name a file.
[[nodiscard]] std::vector<std::byte> encode_exr(std::uint32_t width, std::uint32_t height,
                                                std::span<const glm::vec3> texels);

}  // namespace candela
