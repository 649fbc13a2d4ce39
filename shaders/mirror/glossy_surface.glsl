// The glossy surface at a pixel of the G-buffer, and the lobe of directions that it reflects in the mirror direction.
#include "bindings.glsl"
#include "maths.glsl"
#include "shading/gloss.glsl"
#include "surfaces/surface.glsl"
#include "view/view.glsl"

layout(binding = UNIT_DEPTH) uniform sampler2D surface_depth;
layout(binding = UNIT_NORMAL) uniform sampler2D surface_normal;
layout(binding = UNIT_ALBEDO) uniform sampler2D gbuffer_albedo;
layout(binding = UNIT_MIRROR) uniform sampler2D gbuffer_mirror;
layout(binding = UNIT_GLOSS) uniform sampler2D gbuffer_gloss;
#ifdef BUMPY
layout(binding = UNIT_BUMPS) uniform sampler2D gbuffer_bumps;
#endif

bool is_surface(ivec2 at) { return texelFetch(surface_depth, at, 0).r > 0.0; }

// As shading_normal gives it for the surface of a pixel.
vec3 normal_at(ivec2 at) {
#ifdef BUMPY
    return octahedral_decode(texelFetch(gbuffer_bumps, at, 0).xy);
#else
    return octahedral_decode(texelFetch(surface_normal, at, 0).rg);
#endif
}

Surface glossy_surface(ivec2 at) {
    PackedSurface stored = PackedSurface(texelFetch(gbuffer_albedo, at, 0).rgb, texelFetch(surface_normal, at, 0).rg);
    vec3 window = vec3(vec2(at) + 0.5, texelFetch(surface_depth, at, 0).r);
    Surface surface = unpack_surface(stored, window, view.target_size, view.world_from_clip);
    set_gloss(surface, PackedGloss(texelFetch(gbuffer_mirror, at, 0), texelFetch(gbuffer_gloss, at, 0).rg));
#ifdef BUMPY
    vec4 bumps = texelFetch(gbuffer_bumps, at, 0);
    set_bumps(surface, PackedBumps(bumps.xy, bumps.z));
#endif
    return surface;
}

// How much of what the surface reflects in the mirror direction is found by rays.
float share_by_rays(Surface surface) {
    return surface.mirror == vec4(0.0) ? 0.0 : share_of_rays(surface.roughness);
}

// The surface's normal is +Z in the space of its microfacets.
struct Facets {
    vec3 tangent;
    vec3 bitangent;
    vec3 normal;
    vec3 viewer;  // direction, in their space
    float alpha;
};

Facets facets_of(Surface surface) {
    Facets facets;
    facets.normal = shading_normal(surface);
    basis_around(facets.normal, facets.tangent, facets.bitangent);
    vec3 viewer = surface.to_viewer;
    facets.viewer = vec3(dot(viewer, facets.tangent), dot(viewer, facets.bitangent), cosine_to_viewer(surface));
    facets.viewer = normalize(facets.viewer);
    facets.alpha = max(surface.roughness * surface.roughness, LEAST_TRACED_ALPHA);
    return facets;
}

// A direction that the surface reflects to the viewer, for `u` in [0, 1)²: in proportion to the area of the microfacets
// that the viewer sees (Heitz, "Sampling the GGX Distribution of Visible Normals", JCGT 2018). May be below the surface.
vec3 sampled_direction(Facets facets, vec2 u) {
    vec3 stretched = normalize(vec3(facets.alpha * facets.viewer.xy, facets.viewer.z));
    float across2 = dot(stretched.xy, stretched.xy);
    vec3 first = across2 > 0.0 ? vec3(-stretched.y, stretched.x, 0.0) * inversesqrt(across2) : vec3(1.0, 0.0, 0.0);
    vec3 second = cross(stretched, first);
    float x = sqrt(u.x) * cos(2.0 * PI * u.y);
    float y = mix(sqrt(max(1.0 - x * x, 0.0)), sqrt(u.x) * sin(2.0 * PI * u.y), 0.5 * (1.0 + stretched.z));
    vec3 facet = x * first + y * second + sqrt(max(1.0 - x * x - y * y, 0.0)) * stretched;
    facet = normalize(vec3(facets.alpha * facet.xy, max(facet.z, 0.0)));
    vec3 found = reflect(-facets.viewer, facet);
    return found.x * facets.tangent + found.y * facets.bitangent + found.z * facets.normal;
}

// Densities of a direction.
struct Lobe {
    float sampled;    // with which sampled_direction finds it, 1/sr
    float reflected;  // of light that the surface reflects, without Fresnel's term: its share is the mean of the ratio
};

Lobe lobe_towards(vec3 direction, Facets facets) {
    float cosine = dot(facets.normal, direction);
    if (cosine <= 0.0) return Lobe(0.0, 0.0);
    vec3 in_space = vec3(dot(direction, facets.tangent), dot(direction, facets.bitangent), cosine);
    vec3 middle = normalize(in_space + facets.viewer);
    float alpha2 = facets.alpha * facets.alpha;
    float density = facets_along(middle.z, dot(middle.xy, middle.xy), alpha2);
    float of_viewer = masked_cosine(facets.viewer.z, alpha2);
    float of_light = masked_cosine(cosine, alpha2);
    float sampled = 0.5 * density / (facets.viewer.z + of_viewer);
    float reflected = 0.5 * density * cosine / (cosine * of_viewer + facets.viewer.z * of_light);
    return Lobe(sampled, reflected);
}
