#include "renderer/tools/reference/hemispherical_albedo.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <glm/common.hpp>

namespace candela::reference {

namespace {

// Of the table over the roughness, √alpha, over which albedo changes evenly.
constexpr std::size_t intervals = 32;
constexpr int samples = 8192;

/// Evenly spread over the unit cube: the R3 sequence (Roberts, "The Unreasonable Effectiveness of Quasirandom
/// Sequences", 2018).
glm::vec3 spread(int index) {
    return glm::fract(0.5 + static_cast<double>(index) *
                                glm::dvec3(0.8191725133961645, 0.6710436067037893, 0.5497004779019703));
}

/// Of light that arrives equally from all sides, the share that the surface reflects: the mean over
/// cosine-distributed viewers. `part` takes the only part of the BSDF that counts.
template <class Part>
float mean_albedo(const Gloss& gloss, Part part) {
    double sum = 0.0;
    for (int i = 0; i < samples; ++i) {
        const glm::vec3 u = spread(i);
        const glm::vec3 view(std::sqrt(1.0F - u.z), 0.0F, std::sqrt(u.z));
        const Bsdf bsdf = part(Bsdf(gloss, {0.0F, 0.0F, 1.0F}, view));
        const glm::vec3 towards = bsdf.draw(0.0F, glm::vec2(u));
        const float density = bsdf.density(towards);
        if (density > 0.0F) sum += static_cast<double>(bsdf.value(towards).r / density);
    }
    return static_cast<float>(sum / samples);
}

/// What microfacets reflect if F is 1, and if F is Schlick's (1 - cosine)⁵, which F increases with.
struct Mirrored {
    float all;
    float grazing;
};

Mirrored mirrored(float roughness) {
    const auto part = [](const Bsdf& bsdf) { return bsdf.mirror_part(); };
    const float alpha = roughness * roughness;
    return {mean_albedo({glm::vec3(0.0F), glm::vec3(1.0F), 1.0F, alpha}, part),
            mean_albedo({glm::vec3(0.0F), glm::vec3(0.0F), 1.0F, alpha}, part)};
}

struct Table {
    std::array<Mirrored, intervals + 1> by_roughness{};
    /// The mean of (1 - cosine)⁵ between cosine-distributed directions and the microfacet halfway.
    float grazing;

    Table() {
        for (std::size_t i = 0; i <= intervals; ++i) {
            by_roughness[i] = mirrored(static_cast<float>(i) / static_cast<float>(intervals));
        }
        const auto part = [](const Bsdf& bsdf) { return bsdf.diffuse_part(); };
        grazing = 1.0F - mean_albedo({glm::vec3(1.0F), glm::vec3(0.0F), 1.0F, 1.0F}, part);
    }

    [[nodiscard]] Mirrored at(float alpha) const {
        const float place = std::sqrt(alpha) * static_cast<float>(intervals);
        const std::size_t first = std::min(static_cast<std::size_t>(place), intervals - 1);
        const float share = place - static_cast<float>(first);
        const Mirrored& a = by_roughness[first];
        const Mirrored& b = by_roughness[first + 1];
        return {glm::mix(a.all, b.all, share), glm::mix(a.grazing, b.grazing, share)};
    }
};

}  // namespace

glm::vec3 hemispherical_albedo(const Gloss& gloss) {
    static const Table table;
    // F = f0 (1 - g) + f90 g, with g = (1 - cosine)⁵; its largest channel is that of f0.
    const Mirrored mirrored = table.at(gloss.alpha);
    const float largest = std::max({gloss.f0.r, gloss.f0.g, gloss.f0.b});
    const float into = 1.0F - largest * (1.0F - table.grazing) - gloss.f90 * table.grazing;
    return gloss.f0 * (mirrored.all - mirrored.grazing) + gloss.f90 * mirrored.grazing + gloss.diffuse * into;
}

}  // namespace candela::reference
