// What glossy pixels show in the mirror direction: the mean over the rays of a pixel and its neighbours, each weighted by
// how much of the light from where it ended the pixel's surface reflects to the viewer, over the density of rays there
// (Stachowiak and Uludag, "Stochastic Screen-Space Reflections", SIGGRAPH 2015 courses). A mirror shows its own ray alone.
// Added to the radiance. One fragment per pixel.
#include "mirror/glossy_surface.glsl"
#ifdef EMITTERS
#include "mirror/emitter_light.glsl"
#endif

layout(binding = UNIT_MIRRORED_PLACE) uniform sampler2D mirrored_place;    // mirror_rays.frag
layout(binding = UNIT_MIRRORED_NORMAL) uniform sampler2D mirrored_normal;
layout(binding = UNIT_MIRRORED_SOURCE) uniform sampler2D mirrored_source;
#ifdef REFLECTED
layout(binding = UNIT_INDIRECT) uniform sampler2D mirrored_radiance;  // reflected by what the rays met
#endif

#ifdef EMITTERS
layout(binding = UNIT_MIRRORED_ALBEDO) uniform sampler2D mirrored_albedo;
#endif

layout(location = 0) out vec4 radiance;

uniform uint ray_round;  // as in mirror_rays.frag

const int REACH = 2;  // pixels
const float FEW_RAYS = 6.0;

// Towards where the ray of another pixel ended.
vec3 direction_to_end(ivec2 there, vec3 position) {
    vec4 place = texelFetch(mirrored_place, there, 0);
    if (place.x > 0.0) return normalize(place.yzw - position);
    return -octahedral_decode(texelFetch(mirrored_normal, there, 0).ba);
}

// `emitted`: how much of the light of emitters the rays are to find.
vec3 light_from_end(ivec2 there, vec3 source, float emitted) {
    if (texelFetch(mirrored_place, there, 0).x > 0.0) source *= emitted;
#ifdef REFLECTED
    source += texelFetch(mirrored_radiance, there, 0).rgb;
#endif
    return source;
}

// A sum over rays, of which one that found a small bright thing would show as a dot: it counts as much as all others at
// most, unless few rays have any weight, as in a mirror. The limit rises with the number of frames in a mean.
struct Sum {
    vec3 light;
    float weight;
    float weight2;  // sum of squares
    vec3 brightest;
};

void add_ray(inout Sum sum, vec3 light, float weight) {
    vec3 weighted = weight * light;
    sum.light += weighted;
    sum.weight += weight;
    sum.weight2 += weight * weight;
    if (largest(weighted) > largest(sum.brightest)) sum.brightest = weighted;
}

vec3 mean_of(Sum sum) {
    float most = float(ray_round + 1u) * largest(sum.light - sum.brightest);
    bool few = sum.weight * sum.weight < FEW_RAYS * sum.weight2;
    float kept = few ? 1.0 : min(most / max(largest(sum.brightest), 1e-20), 1.0);
    return (sum.light - (1.0 - kept) * sum.brightest) / sum.weight;
}

#ifdef EMITTERS

// Of rays that were sent to emitters.
struct Sent {
    float all;
    float arrived;
};

void add_sent(inout Sent sent, ivec2 there, float weight) {
    float aimed = texelFetch(mirrored_albedo, there, 0).a;
    sent.all += weight * abs(aimed);
    sent.arrived += weight * max(aimed, 0.0);
}

vec3 light_by_sum(Sent sent, Surface surface) {
    float visible = sent.all > 0.0 ? sent.arrived / sent.all : 1.0;
    return visible * share_of_sum(surface) * light_of_emitters(surface);
}

#endif

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    if (!is_surface(at)) discard;
    Surface surface = glossy_surface(at);
    float by_rays = share_by_rays(surface);
    if (by_rays == 0.0) discard;
    Facets facets = facets_of(surface);
    Sum sum = Sum(vec3(0.0), 0.0, 0.0, vec3(0.0));
    float emitted = 1.0;
#ifdef EMITTERS
    Sent sent = Sent(0.0, 0.0);
    emitted -= share_of_sum(surface);
#endif
    for (int y = -REACH; y <= REACH; ++y) {
        for (int x = -REACH; x <= REACH; ++x) {
            ivec2 there = clamp(at + ivec2(x, y), ivec2(0), ivec2(view.target_size) - 1);
            vec4 source = texelFetch(mirrored_source, there, 0);
            if (source.a <= 0.0) continue;
            float weight = lobe_towards(direction_to_end(there, surface.position), facets).reflected / source.a;
            if (weight <= 0.0) continue;
            add_ray(sum, light_from_end(there, source.rgb, emitted), weight);
#ifdef EMITTERS
            add_sent(sent, there, weight);
#endif
        }
    }
    vec3 light = vec3(0.0);
    if (sum.weight > 0.0) light = mirror_share(shares_at(surface), surface) * mean_of(sum);
#ifdef EMITTERS
    light += light_by_sum(sent, surface);
#endif
    radiance = vec4(open_share(surface) * by_rays * light, 1.0);
}
