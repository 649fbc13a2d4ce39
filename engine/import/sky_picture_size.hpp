#pragma once

#include <cstdint>
#include <span>

namespace candela {

struct PictureSize {
    std::int64_t width = 0;   ///< pixels
    std::int64_t height = 0;  ///< pixels
};

/// The size that a picture of the sky states, before it is decoded. Throws SceneError if it is of no known
/// kind or if its size is not possible.
[[nodiscard]] PictureSize sky_picture_size(std::span<const unsigned char> bytes);

/// Throws SceneError if a picture of the sky cannot have this size: twice as wide as high, and not wider than
/// load_sky_picture allows.
void check_sky_size(std::int64_t width, std::int64_t height);

}  // namespace candela
