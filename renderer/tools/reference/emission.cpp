#include "renderer/tools/reference/emission.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "renderer/tools/reference/constants.hpp"
#include "renderer/tools/reference/sampling.hpp"

namespace candela::reference {

namespace {

float flux(const Light& light, const Sphere& bounds) {
    const float intensity = light.intensity.r + light.intensity.g + light.intensity.b;
    const bool directional = light.kind == Light::Kind::directional;
    return intensity * (directional ? pi * bounds.radius * bounds.radius : light.solid_angle);
}

/// Uniformly distributed in the cone of this solid angle (sr) around the axis.
glm::vec3 direction_in_cone(glm::vec3 axis, float solid_angle, glm::vec2 u) {
    const float cosine = 1.0F - u.x * solid_angle / (2.0F * pi);
    const float sine = std::sqrt(std::max(1.0F - cosine * cosine, 0.0F));
    return across(axis, sine, 2.0F * pi * u.y) + cosine * axis;
}

}  // namespace

Emission::Emission(const std::vector<Light>& lights, const Sphere& bounds) : bounds_(bounds) {
    float total = 0.0F;
    for (const Light& light : lights) total += flux(light, bounds);
    float until = 0.0F;
    for (const Light& light : lights) {
        const float probability = total > 0.0F ? flux(light, bounds) / total : 0.0F;
        until += probability;
        sources_.push_back({light, probability, until});
    }
}

Emission::Draw Emission::draw(float which, glm::vec2 u) const {
    const auto found = std::ranges::upper_bound(sources_, which, {}, &Source::until);
    const Source& source = found == sources_.end() ? sources_.back() : *found;
    const Light& light = source.light;
    Draw drawn{static_cast<std::uint32_t>(&source - sources_.data()),
               {.origin = light.position, .direction = light.direction, .farthest = infinity}};
    if (light.kind == Light::Kind::directional) {
        const glm::vec3 aside = across(light.direction, bounds_.radius * std::sqrt(u.x), 2.0F * pi * u.y);
        drawn.ray.origin = bounds_.centre + aside - 2.0F * bounds_.radius * light.direction;
    } else {
        drawn.ray.direction = direction_in_cone(light.direction, light.solid_angle, u);
    }
    return drawn;
}

float Emission::density(std::uint32_t light, const Arrival& arrival, float cosine) const {
    const Source& source = sources_[light];
    if (source.light.kind == Light::Kind::directional) {
        return source.probability * cosine / (pi * bounds_.radius * bounds_.radius);
    }
    return source.probability * cosine / (source.light.solid_angle * arrival.distance * arrival.distance);
}

}  // namespace candela::reference
