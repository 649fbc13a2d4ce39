#include "renderer/passes/scene/normal_levels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace candela {
namespace {

/// The components of normals before they are normalised, by what a texel stores: glTF 2.0, section 3.9.3.
std::array<float, 256> stored_components() {
    std::array<float, 256> components{};
    for (std::size_t i = 0; i < components.size(); ++i) {
        components[i] = static_cast<float>(i) / 127.5F - 1.0F;
    }
    return components;
}

glm::uvec2 half_of(const glm::uvec2& size) {
    return glm::max(size / 2U, glm::uvec2(1));
}

/// Means of four texels each of a level of this size. `at` is the mean under a texel, by its index: the
/// length of one says how much the normals differ.
template <class At>
std::vector<glm::vec3> halved(const glm::uvec2& size, const At& at) {
    const glm::uvec2 half = half_of(size);
    std::vector<glm::vec3> means;
    means.reserve(std::size_t{half.x} * half.y);
    for (std::uint32_t y = 0; y < half.y; ++y) {
        const std::size_t upper = std::size_t{2 * y} * size.x;
        const std::size_t lower = std::size_t{std::min(2 * y + 1, size.y - 1)} * size.x;
        for (std::uint32_t x = 0; x < half.x; ++x) {
            const std::uint32_t left = 2 * x;
            const std::uint32_t right = std::min(2 * x + 1, size.x - 1);
            const glm::vec3 sum = at(upper + left) + at(upper + right);
            means.push_back(0.25F * (sum + (at(lower + left) + at(lower + right))));
        }
    }
    return means;
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
    // Positive numbers are rounded by cutting off: glm::round calls a function for each.
    return {127.5F * direction + 128.0F, 255.0F * slope + 0.5F};
}

NormalLevel level_of(const std::vector<glm::vec3>& means) {
    NormalLevel level;
    level.reserve(means.size());
    for (const glm::vec3& mean : means) level.push_back(encoded(mean));
    return level;
}

NormalLevel first_level(const Image& image) {
    NormalLevel level;
    level.reserve(image.texels.size());
    for (const glm::u8vec4& texel : image.texels) level.emplace_back(texel.x, texel.y, texel.z, 0);
    return level;
}

}  // namespace

std::vector<NormalLevel> normal_levels(const Image& image) {
    std::vector<NormalLevel> levels{first_level(image)};
    glm::uvec2 size(image.width, image.height);
    if (size == glm::uvec2(1)) return levels;
    const std::array<float, 256> components = stored_components();
    std::vector<glm::vec3> means = halved(size, [&](std::size_t i) {
        const glm::u8vec4& texel = image.texels[i];
        return glm::normalize(glm::vec3(components[texel.x], components[texel.y], components[texel.z]));
    });
    levels.push_back(level_of(means));
    for (size = half_of(size); size != glm::uvec2(1); size = half_of(size)) {
        means = halved(size, [&](std::size_t i) { return means[i]; });
        levels.push_back(level_of(means));
    }
    return levels;
}

}  // namespace candela
