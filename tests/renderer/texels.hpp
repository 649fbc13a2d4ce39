#pragma once

#include <vector>

#include <candela/view.hpp>
#include "renderer/gl/functions.hpp"
#include "tests/renderer/scene_builder.hpp"

namespace candela {

/// The texels of a result, row by row, the bottom row first; missing channels are (0, 0, 0, 1).
[[nodiscard]] std::vector<glm::vec4> texels(const gl::Functions& gl, const ResultTexture& result);
/// The same for depth, in the first channel.
[[nodiscard]] std::vector<glm::vec4> depths(const gl::Functions& gl, const ResultTexture& result);
[[nodiscard]] Picture picture_of(const gl::Functions& gl, const ResultTexture& radiance);

/// The inverse of the octahedral map, from its definition: the sum of the coordinates' absolute values is 1,
/// and the lower half is folded over the diagonals.
[[nodiscard]] glm::vec3 decoded_normal(glm::vec2 p);

}  // namespace candela
