#include "renderer/tools/reference/lights.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include <candela/scene/hierarchy.hpp>
#include <candela/scene/lights.hpp>

#include "renderer/tools/reference/constants.hpp"

namespace candela::reference {

namespace {

/// A point light with the entity's pose, which looks along its -Z. The callers fill in what differs.
template <class Source>
Light placed(const glm::mat4& to_world, const Source& source) {
    return {.kind = Light::Kind::point,
            .position = glm::vec3(to_world[3]),
            .direction = glm::normalize(-glm::vec3(to_world[2])),
            .intensity = source.colour * strength_of(source),
            .range = infinity,
            .solid_angle = 4.0F * pi,
            .cone_scale = 0.0F,
            .cone_offset = 1.0F,
            .casts_shadow = source.casts_shadow};
}

Light light_of(const glm::mat4& to_world, const PointLight& source) {
    Light light = placed(to_world, source);
    light.range = source.range;
    return light;
}

Light light_of(const glm::mat4& to_world, const SpotLight& source) {
    Light light = placed(to_world, source);
    light.kind = Light::Kind::spot;
    light.range = source.range;
    // As in the reference code of KHR_lights_punctual, including its guard against equal cones.
    const float ramp = std::cos(source.inner_cone) - std::cos(source.outer_cone);
    light.cone_scale = 1.0F / std::max(ramp, 1e-3F);
    light.solid_angle = 2.0F * pi * (1.0F - std::cos(source.outer_cone));
    light.cone_offset = -std::cos(source.outer_cone) * light.cone_scale;
    return light;
}

Light light_of(const glm::mat4& to_world, const DirectionalLight& source) {
    Light light = placed(to_world, source);
    light.kind = Light::Kind::directional;
    return light;
}

float cone(const Light& light, glm::vec3 to_light) {
    const float cosine = -glm::dot(to_light, light.direction);
    const float ramp = std::clamp(cosine * light.cone_scale + light.cone_offset, 0.0F, 1.0F);
    return ramp * ramp;
}

}  // namespace

std::vector<Light> lights_of(const World& world) {
    std::vector<Light> lights;
    WorldMatrices world_matrices(world);
    visit_lights(world, [&](Entity entity, const auto& source) {
        lights.push_back(light_of(world_matrices(entity), source));
    });
    return lights;
}

Arrival arrival(const Light& light, glm::vec3 position) {
    if (light.kind == Light::Kind::directional) return {-light.direction, infinity, light.intensity};
    const glm::vec3 path = light.position - position;
    const float squared = glm::dot(path, path);
    if (squared == 0.0F || squared >= light.range * light.range) return {{}, 0.0F, glm::vec3(0.0F)};
    const float distance = std::sqrt(squared);
    const float ratio = squared / (light.range * light.range);
    const float window = std::clamp(1.0F - ratio * ratio, 0.0F, 1.0F);
    const glm::vec3 towards = path / distance;
    return {towards, distance, light.intensity * (window * cone(light, towards) / squared)};
}

}  // namespace candela::reference
