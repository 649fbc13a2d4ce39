#include "renderer/passes/scene/normal_levels.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace candela {
namespace {

/// Means of unit normals. The length says how much they differ.
struct Means {
    glm::uvec2 size;
    std::vector<glm::vec3> texels;
};

/// glTF 2.0, section 3.9.3.
glm::vec3 decoded(const glm::u8vec4& texel) {
    return glm::normalize(glm::vec3(texel) / 127.5F - 1.0F);
}

Means means_of(const Image& image) {
    Means means{.size = {image.width, image.height}, .texels = {}};
    means.texels.reserve(image.texels.size());
    for (const glm::u8vec4& texel : image.texels) means.texels.push_back(decoded(texel));
    return means;
}

Means halved(const Means& larger) {
    const auto at = [&](std::uint32_t x, std::uint32_t y) {
        const glm::uvec2 inside = glm::min(glm::uvec2(x, y), larger.size - 1U);
        return larger.texels[std::size_t{inside.y} * larger.size.x + inside.x];
    };
    Means half{.size = glm::max(larger.size / 2U, glm::uvec2(1)), .texels = {}};
    half.texels.reserve(std::size_t{half.size.x} * half.size.y);
    for (std::uint32_t y = 0; y < half.size.y; ++y) {
        for (std::uint32_t x = 0; x < half.size.x; ++x) {
            const glm::vec3 upper = at(2 * x, 2 * y) + at(2 * x + 1, 2 * y);
            half.texels.push_back(0.25F * (upper + (at(2 * x, 2 * y + 1) + at(2 * x + 1, 2 * y + 1))));
        }
    }
    return half;
}

/// Mean square of the slopes of normals against their mean direction: Toksvig, "Mipmapping Normal Maps"
/// (2005), whose variance is that along one axis.
float mean_square_slope(float length) {
    constexpr float most_rounding = 1.0F / 255.0F;  // of a component
    const float square = 2.0F * (1.0F - length) / std::max(length, 1e-3F);
    return std::max(square - 2.0F * most_rounding * most_rounding, 0.0F);
}

glm::u8vec4 encoded(const glm::vec3& mean) {
    const float length = glm::length(mean);
    const glm::vec3 direction = length > 0.0F ? mean / length : glm::vec3(0, 0, 1);
    const float slope = std::min(std::sqrt(mean_square_slope(length)), 1.0F);
    return glm::round(glm::vec4(127.5F * direction + 127.5F, 255.0F * slope));
}

}  // namespace

std::vector<NormalLevel> normal_levels(const Image& image) {
    std::vector<NormalLevel> levels{image.texels};
    for (glm::u8vec4& texel : levels.front()) texel.a = 0;
    Means means = means_of(image);
    while (means.size != glm::uvec2(1)) {
        means = halved(means);
        NormalLevel& level = levels.emplace_back();
        level.reserve(means.texels.size());
        for (const glm::vec3& mean : means.texels) level.push_back(encoded(mean));
    }
    return levels;
}

}  // namespace candela
