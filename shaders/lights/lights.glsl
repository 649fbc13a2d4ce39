// Light that a punctual light sends to a point. Used by shading, by the tracing of VPLs and by surfels.
#include "maths.glsl"
#include "types.glsl"

// KHR_lights_punctual: 1 near the light, 0 from `range` on.
float range_window(float distance, float range) {
    float x = distance / range;
    return clamp(1.0 - x * x * x * x, 0.0, 1.0);
}

// KHR_lights_punctual: 1 inside the inner cone, 0 outside the outer one.
float cone_falloff(Light light, float cos_angle) {
    float x = clamp(cos_angle * light.shape.x + light.shape.y, 0.0, 1.0);
    return x * x;
}

struct Incident {
    vec3 direction;   // unit, towards the light
    vec3 irradiance;  // on a surface that faces the light, unoccluded; lux or W/m²
};

Incident incident_light(Light light, vec3 position) {
    if (light.kind == LIGHT_DIRECTIONAL) return Incident(-light.direction, light.intensity);
    vec3 to_light = light.position - position;
    float distance2 = max(dot(to_light, to_light), 1e-12);
    float distance = sqrt(distance2);
    vec3 direction = to_light / distance;
    vec3 irradiance = light.intensity * (range_window(distance, light.range) / distance2);
    if (light.kind == LIGHT_SPOT) irradiance *= cone_falloff(light, -dot(direction, light.direction));
    return Incident(direction, irradiance);
}
