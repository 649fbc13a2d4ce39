#pragma once

#include <cstdint>

namespace candela {

/// Throws SceneError if a picture of the sky cannot have this size: twice as wide as high, and not wider than
/// load_sky_picture allows.
void check_sky_size(std::int64_t width, std::int64_t height);

}  // namespace candela
