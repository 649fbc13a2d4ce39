// Rays that leave a light. Each ray of a light carries the same flux.
#include "lights/lights.glsl"
#include "sampling.glsl"

// Cosine of the angle to a spot's axis, distributed like its intensity, for `u` in [0, 1): the inverse of the
// cumulative flux of the inner cone and then of the quadratic falloff. See theory.md, "Directions".
float sample_spot_cosine(Light light, float u) {
    float inner = 1.0 - light.cos_inner;
    float falloff = (light.cos_inner - light.cos_outer) / 3.0;
    float x = u * (inner + falloff);
    if (x < inner) return 1.0 - x;
    return light.cos_outer + (light.cos_inner - light.cos_outer) * pow(max(1.0 - (x - inner) / falloff, 0.0), 1.0 / 3.0);
}

// Origin and unit direction of the ray for `u` in [0, 1)². Rays of a directional light start on its footprint.
void sample_emission(Light light, vec2 u, out vec3 origin, out vec3 direction) {
    origin = light.position;
    direction = light.direction;
    if (light.kind == LIGHT_POINT) direction = direction_at(vec3(0.0, 0.0, 1.0), 1.0 - 2.0 * u.x, u.y);
    if (light.kind == LIGHT_SPOT) direction = direction_at(light.direction, sample_spot_cosine(light, u.x), u.y);
    if (light.kind == LIGHT_DIRECTIONAL) {
        vec3 tangent, bitangent;
        basis_around(light.direction, tangent, bitangent);
        vec2 at = (2.0 * u - 1.0) * light.shape;
        origin += at.x * tangent + at.y * bitangent;
    }
}
