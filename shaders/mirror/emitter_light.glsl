// What a rough surface reflects in the mirror direction of the light of emitting surfels, if nothing hides them.
#include "bindings.glsl"
#include "shading/gloss.glsl"
#include "types.glsl"
#include "vpls/vpl_constants.glsl"

layout(std430, binding = BINDING_LIT_EMITTERS) readonly restrict buffer LitEmitters { LitEmitter lit_emitters[]; };

uint emitter_count() { return vpl_constants.first_sky_patch - vpl_constants.first_emitter; }

// How much of the emitters' light is found by the sum below. In smoother surfaces, single surfels would be visible.
float share_of_sum(Surface surface) { return smoothstep(0.08, 0.15, surface.roughness); }

// Radiance from one of them. It is a disc: the lobe is as wide as the disc's light spreads the half vectors.
vec3 light_of(LitEmitter emitter, Surface surface) {
    vec3 apart = emitter.position - surface.position;
    float distance2 = dot(apart, apart) + emitter.area / PI;
    vec3 direction = apart * inversesqrt(max(dot(apart, apart), 1e-20));
    float cos_emitter = -dot(emitter.normal, direction);
    float cos_surface = dot(shading_normal(surface), direction);
    if (cos_emitter <= 0.0 || cos_surface <= 0.0 || dot(face_normal(surface), direction) <= 0.0) return vec3(0.0);
    vec3 irradiance = emitter.flux / PI * (cos_emitter * cos_surface / distance2);
    float alpha = surface.roughness * surface.roughness;
    float wider = sqrt(alpha * alpha + 0.25 * emitter.area / (PI * distance2));
    surface.roughness = min(sqrt(wider), 1.0);
    return irradiance * response_to(direction, surface).mirror;
}

vec3 light_of_emitters(Surface surface) {
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < emitter_count(); ++i) sum += light_of(lit_emitters[i], surface);
    return sum;
}
