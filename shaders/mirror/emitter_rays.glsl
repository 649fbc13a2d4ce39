// Light of emitting surfels in rough surfaces, where rays along the lobe would seldom find them and show as dots. Their
// unshadowed light is a sum (emitter_light.glsl); a part of the rays is sent to them, to find how much of it is blocked
// (Heitz et al., "Combining Analytic Direct Illumination and Stochastic Shadows", I3D 2018). All rays have the density of
// both kinds together (Veach and Guibas, "Optimally Combining Sampling Techniques for Monte Carlo Rendering", SIGGRAPH
// 1995: one-sample model, balance heuristic).
#include "bindings.glsl"
#include "maths.glsl"
#include "mirror/glossy_surface.glsl"
#include "mirror/emitter_light.glsl"

const uint MOST_CHOICES = 16u;  // emitters that a ray chooses from; neighbouring pixels have others
const float MOST_TO_EMITTERS = 0.25;  // share of the rays

// Every `stride`-th emitter, each of which stands for its neighbours: a disc that is `stride` times as large.
struct Choices {
    uint first;
    uint stride;
    uint count;
};

Choices choices_at(uint random) {
    uint emitters = emitter_count();
    uint stride = (emitters + MOST_CHOICES - 1u) / MOST_CHOICES;
    if (stride == 0u) return Choices(0u, 1u, 0u);
    uint first = random % stride;
    return Choices(first, stride, (emitters - first + stride - 1u) / stride);
}

LitEmitter choice(Choices choices, uint i) {
    LitEmitter emitter = lit_emitters[choices.first + i * choices.stride];
    emitter.flux *= float(choices.stride);
    emitter.area *= float(choices.stride);
    return emitter;
}

float share_to_emitters(Surface surface) { return MOST_TO_EMITTERS * share_of_sum(surface); }

// How likely a ray goes to an emitter: in proportion to its irradiance on a surface that faces it.
float likelihood(LitEmitter emitter, vec3 origin) {
    vec3 apart = emitter.position - origin;
    float distance2 = dot(apart, apart);
    float cosine = -dot(emitter.normal, apart) * inversesqrt(max(distance2, 1e-20));
    return largest(emitter.flux) * max(cosine, 0.0) / (distance2 + emitter.area);
}

// Where a direction meets the disc of an emitter, in metres; 0: nowhere.
float distance_to_disc(LitEmitter emitter, vec3 origin, vec3 direction) {
    float towards = -dot(emitter.normal, direction);
    if (towards <= 0.0) return 0.0;
    float distance = dot(emitter.normal, origin - emitter.position) / towards;
    vec3 aside = origin + distance * direction - emitter.position;
    return PI * dot(aside, aside) > emitter.area ? 0.0 : max(distance, 0.0);
}

// Emitters in a direction.
struct Aim {
    float density;   // of rays that are sent to them, 1/sr
    float distance;  // metres, of the farthest; 0: there is none
    float radiance;  // of the brightest
};

Aim aim_along(Choices choices, vec3 origin, vec3 direction) {
    Aim aim = Aim(0.0, 0.0, 0.0);
    float all = 0.0;
    for (uint i = 0u; i < choices.count; ++i) {
        LitEmitter emitter = choice(choices, i);
        float likely = likelihood(emitter, origin);
        all += likely;
        float distance = distance_to_disc(emitter, origin, direction);
        if (likely <= 0.0 || distance <= 0.0) continue;
        aim.density += likely * distance * distance / (-dot(emitter.normal, direction) * emitter.area);
        aim.distance = max(aim.distance, distance);
        aim.radiance = max(aim.radiance, largest(emitter.flux) / (PI * emitter.area));
    }
    aim.density /= max(all, 1e-20);
    return aim;
}

// A direction to an emitter; zero if none shines on the origin. `which` in [0, 1), `u` in [0, 1)².
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
        float radius = sqrt(u.x * emitter.area / PI);
        vec2 place = radius * vec2(cos(2.0 * PI * u.y), sin(2.0 * PI * u.y));
        return normalize(emitter.position + place.x * tangent + place.y * bitangent - origin);
    }
    return vec3(0.0);
}
