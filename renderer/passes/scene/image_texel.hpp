#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <glm/vec2.hpp>

#include <candela/scene/components.hpp>

namespace candela {

/// Index of the texel at `at`, in widths of an image of `size` texels.
[[nodiscard]] inline std::uint32_t wrapped(float at, std::uint32_t size, Wrap wrap) {
    float inside = at - std::floor(at);
    if (wrap == Wrap::clamp_to_edge) inside = std::clamp(at, 0.0F, 1.0F);
    if (wrap == Wrap::mirrored_repeat)
        inside = 1.0F - std::abs(1.0F - 2.0F * (0.5F * at - std::floor(0.5F * at)));
    if (!(inside < 1.0F)) return size - 1;  // or not a number
    return std::min(static_cast<std::uint32_t>(inside * static_cast<float>(size)), size - 1);
}

/// The nearest texel to texture coordinates, as the image holds it.
[[nodiscard]] inline glm::u8vec4 texel_at(const Image& image, glm::vec2 uv) {
    const std::size_t x = wrapped(uv.x, image.width, image.wrap_u);
    const std::size_t y = wrapped(uv.y, image.height, image.wrap_v);
    return image.texels[y * image.width + x];
}

}  // namespace candela
