#pragma once

#include <vector>

#include <glm/gtc/type_precision.hpp>

#include <candela/scene/components.hpp>

namespace candela {

/// The texels of a level.
using NormalLevel = std::vector<glm::u8vec4>;

/// The mip levels of a normal texture, from the largest to that of one texel, each half as wide and high as
/// the one before, rounded down. The first one has the texels of the image. Each texel of another one has the
/// mean direction of the normals under it. Alpha is the root of the mean square of their slopes against that
/// direction, from 0 to 1, which is 0 in the first level; what the image's rounding to 8 bits explains is
/// left out. See shaders/README.md, "Bumps that are too small to be seen".
[[nodiscard]] std::vector<NormalLevel> normal_levels(const Image& image);

}  // namespace candela
