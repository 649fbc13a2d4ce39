// Rays of rough surfaces to surfels that emit light, which rays along the lobe alone would seldom find, so that they would
// show as dots. Half of the rays are such; all have the density of both kinds together (Veach and Guibas, "Optimally
// Combining Sampling Techniques for Monte Carlo Rendering", SIGGRAPH 1995: one-sample model, balance heuristic).
#include "bindings.glsl"
#include "maths.glsl"
#include "mirror/glossy_surface.glsl"
#include "types.glsl"
#include "vpls/vpl_constants.glsl"

layout(std430, binding = BINDING_LIT_EMITTERS) readonly restrict buffer LitEmitters { LitEmitter lit_emitters[]; };

const uint MOST_CHOICES = 16u;  // emitters that a ray chooses from; neighbouring pixels have others

// Every `stride`-th emitter, each of which stands for its neighbours: a disc that is `stride` times as large.
struct Choices {
    uint first;
    uint stride;
    uint count;
};

Choices choices_at(uint random) {
    uint emitters = vpl_constants.first_sky_patch - vpl_constants.first_emitter;
    uint stride = (emitters + MOST_CHOICES - 1u) / MOST_CHOICES;
    if (stride == 0u) return Choices(0u, 1u, 0u);
    uint first = random % stride;
    return Choices(first, stride, (emitters - first + stride - 1u) / stride);
}

LitEmitter choice(Choices choices, uint i) { return lit_emitters[choices.first + i * choices.stride]; }

// Share of the rays. A smooth surface finds what it shows by its lobe.
float share_to_emitters(Surface surface) { return 0.5 * smoothstep(0.05, 0.2, surface.roughness); }

// How likely a ray goes to an emitter: in proportion to its irradiance on a surface that faces it.
float likelihood(LitEmitter emitter, vec3 origin) {
    vec3 apart = emitter.position - origin;
    float distance2 = dot(apart, apart);
    float cosine = -dot(emitter.normal, apart) * inversesqrt(max(distance2, 1e-20));
    return largest(emitter.flux) * max(cosine, 0.0) / (distance2 + emitter.area);
}

// Density with which a point of an emitter's disc lies in a direction, 1/sr; 0: none does.
float disc_density(LitEmitter emitter, float area, vec3 origin, vec3 direction) {
    float towards = -dot(emitter.normal, direction);
    float distance = dot(emitter.normal, origin - emitter.position) / towards;
    if (towards <= 0.0 || distance <= 0.0) return 0.0;
    vec3 aside = origin + distance * direction - emitter.position;
    return PI * dot(aside, aside) > area ? 0.0 : distance * distance / (towards * area);
}

// Density of rays to emitters in a direction, 1/sr.
float emitter_density(Choices choices, vec3 origin, vec3 direction) {
    float sum = 0.0;
    float all = 0.0;
    for (uint i = 0u; i < choices.count; ++i) {
        LitEmitter emitter = choice(choices, i);
        float likely = likelihood(emitter, origin);
        all += likely;
        sum += likely * disc_density(emitter, emitter.area * float(choices.stride), origin, direction);
    }
    return all > 0.0 ? sum / all : 0.0;
}

// A direction to an emitter; zero if none shines on the origin. `u` in [0, 1)², `which` in [0, 1).
vec3 direction_to_emitter(Choices choices, vec3 origin, float which, vec2 u) {
    float all = 0.0;
    for (uint i = 0u; i < choices.count; ++i) all += likelihood(choice(choices, i), origin);
    float left = which * all;
    for (uint i = 0u; i < choices.count; ++i) {
        LitEmitter emitter = choice(choices, i);
        left -= likelihood(emitter, origin);
        if (left >= 0.0) continue;
        vec3 tangent;
        vec3 bitangent;
        basis_around(emitter.normal, tangent, bitangent);
        float radius = sqrt(u.x * emitter.area * float(choices.stride) / PI);
        vec2 place = radius * vec2(cos(2.0 * PI * u.y), sin(2.0 * PI * u.y));
        return normalize(emitter.position + place.x * tangent + place.y * bitangent - origin);
    }
    return vec3(0.0);
}
