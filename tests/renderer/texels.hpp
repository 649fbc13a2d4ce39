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

}  // namespace candela
