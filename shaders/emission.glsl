// Rays that carry the flux of a light, all alike, and back: where in the unit square a given ray starts.
#include "lights.glsl"
#include "sampling.glsl"

// Cosine to a spot's axis, distributed as its intensity: inverse of the cumulative flux of the inner cone, which is
// constant, followed by that of the quadratic falloff.
float sample_spot_cosine(Light light, float u) {
    float inner = 1.0 - light.cos_inner;
    float falloff = (light.cos_inner - light.cos_outer) / 3.0;
    float x = u * (inner + falloff);
    if (x < inner) return 1.0 - x;
    return light.cos_outer + (light.cos_inner - light.cos_outer) * pow(max(1.0 - (x - inner) / falloff, 0.0), 1.0 / 3.0);
}

// Share of a spot's flux that lies nearer to its axis.
float spot_flux_within(Light light, float cos_angle) {
    float inner = 1.0 - light.cos_inner;
    float ramp = light.cos_inner - light.cos_outer;
    float falloff = ramp / 3.0;
    float x = clamp((cos_angle - light.cos_outer) / ramp, 0.0, 1.0);
    float within = cos_angle >= light.cos_inner ? 1.0 - cos_angle : inner + falloff * (1.0 - x * x * x);
    return within / (inner + falloff);
}

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

// Azimuth around an axis as a fraction of the full circle; inverse of direction_at's.
float azimuth_around(vec3 axis, vec3 direction) {
    vec3 tangent, bitangent;
    basis_around(axis, tangent, bitangent);
    vec2 p = vec2(dot(direction, tangent), dot(direction, bitangent));
    return p == vec2(0.0) ? 0.0 : fract(atan(p.y, p.x) / (2.0 * PI));
}

// Inverse of sample_emission for rays that the light sends; outside of [0, 1]² for others: see is_emitted.
vec2 emission_coordinates(Light light, vec3 origin, vec3 direction) {
    if (light.kind == LIGHT_POINT) {
        return vec2(0.5 - 0.5 * direction.z, azimuth_around(vec3(0.0, 0.0, 1.0), direction));
    }
    if (light.kind == LIGHT_SPOT) {
        float cos_angle = dot(direction, light.direction);
        float within = cos_angle < light.cos_outer ? 2.0 : spot_flux_within(light, cos_angle);
        return vec2(within, azimuth_around(light.direction, direction));
    }
    vec3 tangent, bitangent;
    basis_around(light.direction, tangent, bitangent);
    vec3 offset = origin - light.position;
    vec2 at = vec2(dot(offset, tangent), dot(offset, bitangent));
    // A footprint without extent is a line or a point.
    return 0.5 + 0.5 * at / max(light.shape, vec2(1e-30));
}

// Whether coordinates are those of a ray that the light sends, but for the rounding of its inverse.
bool is_emitted(vec2 u) {
    const float rounding = 1e-5;
    return all(greaterThanEqual(u, vec2(-rounding))) && all(lessThanEqual(u, vec2(1.0 + rounding)));
}
