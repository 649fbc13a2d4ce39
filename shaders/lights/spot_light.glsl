// Spot lights: point lights within a cone. The CPU's half is renderer/passes/lights/spot_light.cpp.
#include "lights/incident.glsl"
#include "sampling.glsl"

// KHR_lights_punctual: 1 inside the inner cone, 0 outside the outer one. `direction`: unit, towards the light.
float cone_falloff(Light light, vec3 direction) {
    // 1 - cos of the angle to the axis, as half the squared distance of unit vectors: exact also for small angles.
    vec3 off_axis = direction + light.direction;
    float x = clamp(light.shape.y - 0.5 * dot(off_axis, off_axis) * light.shape.x, 0.0, 1.0);
    return x * x;
}

// 1 - cos of the angle to the axis, distributed like the intensity, for `u` in [0, 1): the inverse of the cumulative flux
// of the inner cone and then of the quadratic falloff. See README.md, "Directions".
float sample_spot(Light light, float u) {
    float ramp = 1.0 / light.shape.x;
    float outer = light.shape.y * ramp;
    float inner = outer - ramp;
    float x = u * (inner + ramp / 3.0);
    if (x < inner) return x;
    return outer - ramp * pow(max(1.0 - 3.0 * (x - inner) / ramp, 0.0), 1.0 / 3.0);
}

Emission emission_of_spot(Light light, vec2 u) {
    return Emission(light.position, direction_off(light.direction, sample_spot(light, u.x), u.y));
}

// Cosine of the half angle of a cone that contains the light, widened by more than the rounding of directions.
float cone_of_spot(Light light) { return light.cos_outer - 1e-4; }
