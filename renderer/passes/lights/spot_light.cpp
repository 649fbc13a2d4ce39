#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include <candela/scene/hierarchy.hpp>
#include <candela/scene/lights.hpp>
#include "renderer/passes/lights/light_kind.hpp"

// Spot lights; shaders/lights/spot_light.glsl is the other half.

namespace candela {
namespace {

/// 1 - cos(angle) without cancellation, so that it is exact for narrow cones.
float one_minus_cos(float angle) {
    const float half_chord = std::sin(0.5F * angle);
    return 2.0F * half_chord * half_chord;
}

/// The intensity is constant inside the inner cone. From there to the outer cone it falls with the square of
/// a linear ramp in the cosine (KHR_lights_punctual). Its integral over the sphere is
/// 2π ((1 - cᵢ) + (cᵢ - cₒ) / 3), with the cosines cᵢ and cₒ of the inner and outer cone.
LightTable::Entry spot_entry(Entity entity, const SpotLight& light, const glm::mat4& world) {
    const float outer = one_minus_cos(light.outer_cone);
    // The ramp is at least a thousandth of the cone, which avoids a division by zero as the extension
    // suggests.
    const float ramp = std::max(outer - one_minus_cos(light.inner_cone), 1e-3F * outer);
    const float inner = outer - ramp;
    const glm::vec3 intensity = light.colour * light.intensity;
    return {.entity = entity,
            .light = {.position = glm::vec3(world[3]),
                      .kind = LIGHT_SPOT,
                      .direction = direction_of(world),
                      .range = light.range,
                      .intensity = intensity,
                      .cos_outer = 1.0F - outer,
                      .shape = {1.0F / ramp, outer / ramp}},
            .flux = intensity * (hemisphere * (inner + ramp / 3.0F)),
            .casts_shadow = light.casts_shadow};
}

void gather_spot_lights(const WorldReader& world, SceneCheck& check, const SceneMetrics& /*metrics*/,
                        std::vector<LightTable::Entry>& entries) {
    gather_lights<SpotLight>(world, check, entries, spot_entry);
}

/// For narrow cones (less than 45 degrees), the bounding sphere of the cone with its spherical cap: it is
/// smaller than the sphere of radius `range` around the light.
LightBounds bounds_of_spot(const gpu::Light& light) {
    if (light.cos_outer <= std::sqrt(0.5F)) return {light.position, light.range};
    const float radius = light.range / (2.0F * light.cos_outer);
    return {light.position + light.direction * radius, radius};
}

/// Of the cone or of what the light would need without it, whichever is narrower.
ShadowShape shadow_of_spot(const gpu::Light& light, const SceneMetrics& metrics) {
    const ShadowShape around = shadow_around(light.position, metrics);
    const float outer = light.shape.y / light.shape.x;
    const float tangent = std::sqrt(outer * (2.0F - outer)) / (1.0F - outer);
    const bool wide =
        light.cos_outer < cos_widest_map || (around.kind == SHADOW_PERSPECTIVE && around.tangent < tangent);
    return wide ? around : shadow_in_cone(light.position, light.direction, tangent, metrics);
}

}  // namespace

const LightKind spot_light{.gather = gather_spot_lights, .bounds = bounds_of_spot, .shadow = shadow_of_spot};

}  // namespace candela
