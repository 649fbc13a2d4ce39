#include "renderer/passes/scene/mask_levels.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "renderer/passes/scene/image_texel.hpp"
#include "renderer/passes/view/r2_sequence.hpp"

namespace candela {
namespace {

Image with_scaled_alpha(Image image, float scale) {
    for (glm::u8vec4& texel : image.texels) {
        texel.a = static_cast<std::uint8_t>(std::min(scale * static_cast<float>(texel.a) + 0.5F, 255.0F));
    }
    return image;
}

}  // namespace

float coverage(const Image& image, float cutoff) {
    constexpr std::uint32_t places = 4096;
    std::uint32_t covered = 0;
    for (std::uint32_t i = 0; i < places; ++i) {
        covered += alpha_at(image, glm::vec2(r2_point(i, glm::dvec2(0.5)))) < cutoff ? 0U : 1U;
    }
    return static_cast<float>(covered) / static_cast<float>(places);
}

std::optional<Image> with_coverage(const Image& level, float cutoff, float share) {
    std::optional<Image> nearest;
    float least = 0.1F * std::min(share, 1.0F - share);
    float lower = 0.0F, upper = 1.0F;  // of the alpha that becomes the cutoff
    for (int step = 0; step < 10; ++step) {
        const float middle = 0.5F * (lower + upper);
        Image scaled = with_scaled_alpha(level, cutoff / middle);
        const float off = coverage(scaled, cutoff) - share;
        (off > 0.0F ? lower : upper) = middle;
        if (std::abs(off) > least) continue;
        least = std::abs(off);
        nearest = std::move(scaled);
    }
    return nearest;
}

}  // namespace candela
