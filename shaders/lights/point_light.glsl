// Point lights; the CPU's half is renderer/passes/lights/point_light.cpp.
#include "lights/incident.glsl"
#include "sampling.glsl"

// KHR_lights_punctual: 1 near the light, 0 from `range` on.
float range_window(float distance, float range) {
    float x = distance / range;
    return clamp(1.0 - x * x * x * x, 0.0, 1.0);
}

Incident incident_from_point(Light light, vec3 position) {
    vec3 to_light = light.position - position;
    float distance2 = max(dot(to_light, to_light), 1e-12);
    float distance = sqrt(distance2);
    vec3 direction = to_light / distance;
    return Incident(direction, light.intensity * (range_window(distance, light.range) / distance2));
}

Emission emission_of_point(Light light, vec2 u) {
    return Emission(light.position, direction_off(vec3(0.0, 0.0, 1.0), 2.0 * u.x, u.y));
}
