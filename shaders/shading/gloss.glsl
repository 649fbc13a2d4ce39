// How glossy surfaces reflect light: glTF 2.0, appendix B.3. GGX distribution of microfacets, masking and shadowing by
// Smith with correlated heights, Fresnel's term by Schlick. What is not reflected in the mirror direction is reflected
// in all directions.
#include "bindings.glsl"
#include "surfaces/surface.glsl"

#ifdef GLOSSY

// renderer/gpu/mirror_shares.hpp
layout(binding = UNIT_MIRROR_SHARES) uniform sampler2D mirror_shares;

// α of the smoothest surface that reflects lights without extent: the highlight of a smoother one would be smaller than
// a pixel.
const float LEAST_ALPHA = 1.0 / 512.0;
// The same of surfaces whose reflections are found by rays.
const float LEAST_TRACED_ALPHA = 1e-5;
// Interpolated normals may face away from the viewer.
const float LEAST_COSINE = 1e-3;

struct Response {
    vec3 mirror;    // radiance towards the viewer over irradiance, 1/sr
    float diffuse;  // share of the irradiance that the diffuse part reflects
};

// GGX distribution of microfacets, 1/sr. `aside2`: squared sine of the half vector to the normal.
float facets_along(float cos_middle, float aside2, float alpha2) {
    float spread = aside2 + alpha2 * cos_middle * cos_middle;
    return alpha2 / (PI * spread * spread);
}

// Cosine times (1 + 2 Λ), by Smith's Λ of the heights of microfacets.
float masked_cosine(float cosine, float alpha2) { return sqrt(mix(cosine * cosine, 1.0, alpha2)); }

float cosine_to_viewer(Surface surface) { return max(dot(shading_normal(surface), surface.to_viewer), LEAST_COSINE); }

// Light from the unit direction `to_light`, in front of the surface.
Response response_to(vec3 to_light, Surface surface) {
    vec3 normal = shading_normal(surface);
    vec3 middle = normalize(to_light + surface.to_viewer);
    float alpha2 = max(surface.roughness * surface.roughness, LEAST_ALPHA);
    alpha2 *= alpha2;
    float cos_viewer = cosine_to_viewer(surface);
    float cos_light = dot(normal, to_light);
    float cos_middle = dot(normal, middle);
    vec3 aside = cross(normal, middle);
    float facets = facets_along(cos_middle, dot(aside, aside), alpha2);
    float unmasked =
        0.5 / (cos_light * masked_cosine(cos_viewer, alpha2) + cos_viewer * masked_cosine(cos_light, alpha2));
    float grazing = pow(1.0 - clamp(dot(surface.to_viewer, middle), 0.0, 1.0), 5.0);
    vec3 fresnel = mix(surface.mirror.rgb, vec3(surface.mirror.a), grazing);
    return Response(facets * unmasked * fresnel, 1.0 - largest(fresnel));
}

// How much of what a surface reflects in the mirror direction, of anything but lights, is found by rays: mirror_rays.frag.
// Rough surfaces would need too many.
float share_of_rays(float roughness) { return 1.0 - smoothstep(0.6, 0.8, roughness); }

// Share of light from all sides, the same from all, that a surface reflects in the mirror direction. `shares`: of
// mirror_shares.
vec3 mirror_share(vec3 shares, Surface surface) { return shares.x * surface.mirror.rgb + shares.y * surface.mirror.a; }

vec3 shares_at(Surface surface) {
    vec2 last = vec2(textureSize(mirror_shares, 0) - 1);
    vec2 at = vec2(cosine_to_viewer(surface), surface.roughness) * last + 0.5;
    return textureLod(mirror_shares, at / (last + 1.0), 0.0).xyz;
}

// Light from all sides, as if it were the same from all.
Response response_to_all_sides(Surface surface) {
    vec3 shares = shares_at(surface);
    vec3 fresnel = mix(surface.mirror.rgb, vec3(surface.mirror.a), shares.z);
    vec3 mirror = mirror_share(shares, surface);
#ifdef MIRROR_RAYS
    mirror *= 1.0 - share_of_rays(surface.roughness);
#endif
    return Response(mirror / PI, 1.0 - largest(fresnel));
}

#endif
