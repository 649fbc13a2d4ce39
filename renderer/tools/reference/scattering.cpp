#include "renderer/tools/reference/scattering.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace candela::reference {

Scattering scattering(const Surface& surface, glm::vec3 towards) {
    const float cosine = glm::dot(surface.normal, towards);
    if (cosine <= 0.0F) return {0.0F, glm::vec3(0.0F)};
    if (surface.bsdf) return {surface.bsdf->density(towards), surface.bsdf->value(towards)};
    const float density = cosine * std::numbers::inv_pi_v<float>;
    return {density, glm::vec3(density)};
}

Scattering scattering(const Surface& surface, const Surface& from) {
    const glm::vec3 between = from.position - surface.position;
    const float squared = glm::dot(between, between);
    const float cosine_there = -glm::dot(from.face, between);  // times the distance
    if (surface.bsdf) {
        const float distance = std::sqrt(squared);
        const Scattering arriving = scattering(surface, between / distance);
        const float per_area = std::max(cosine_there, 0.0F) / (squared * distance);
        return {arriving.density * per_area, arriving.reflected * per_area};
    }
    const float cosines = glm::dot(surface.normal, between) * cosine_there;
    const float density = std::max(cosines, 0.0F) / (std::numbers::pi_v<float> * squared * squared);
    return {density, glm::vec3(density)};
}

glm::vec3 look_around(const Surface& surface, glm::vec2 u, Sampler& sampler) {
    return surface.bsdf ? surface.bsdf->draw(sampler.next(), u) : cosine_direction(surface.normal, u);
}

}  // namespace candela::reference
