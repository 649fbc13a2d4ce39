#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <glm/common.hpp>
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

/// Alpha of an image, 0 to 1, interpolated between the middles of four texels as textures are.
[[nodiscard]] inline float alpha_at(const Image& image, glm::vec2 uv) {
    const glm::vec2 size(image.width, image.height);
    const glm::vec2 place = uv * size - 0.5F;
    const glm::vec2 corner = glm::floor(place);
    const glm::vec2 share = place - corner;
    const auto alpha = [&](float x, float y) {
        return static_cast<float>(texel_at(image, (corner + 0.5F + glm::vec2(x, y)) / size).a) / 255.0F;
    };
    return glm::mix(glm::mix(alpha(0, 0), alpha(1, 0), share.x), glm::mix(alpha(0, 1), alpha(1, 1), share.x),
                    share.y);
}

}  // namespace candela
