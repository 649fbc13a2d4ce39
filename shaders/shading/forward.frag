// Shades a fragment as it is drawn, without a G-buffer.
#include "surfaces/mesh_surface.glsl"
#include "shading/lighting.glsl"
#include "view/view.glsl"

#ifdef BLENDED
// Dual-source blending computes radiance + (1 - cover) · background. Alpha is 1 where there is a surface.
layout(location = 0, index = 0) out vec4 radiance;
layout(location = 0, index = 1) out vec4 cover;

#ifdef GLASS

// Discards holes of masks, of glass alone: MASKED is for surfaces that are not blended.
float cover_of(float alpha) {
    Material material = materials[material_index];
    if (alpha < material.alpha_cutoff) discard;
    return (material.flags & MATERIAL_ALPHA_IGNORED) != 0u ? 1.0 : alpha;
}

// The share of the light from behind that passes through the surface. It is taken from the diffuse part. Where something
// else than light is shown, none passes.
vec3 take_passing(inout Surface surface) {
#if defined(SHOW_SURFACES) || defined(SHOW_IRRADIANCE)
    return vec3(0.0);
#else
    float transmission = materials[material_index].transmission;
    vec3 passing = transmission * surface.albedo;
#ifdef GLOSSY
    if (transmission > 0.0) passing *= 1.0 - largest(mirror_share(shares_at(surface), surface));
#endif
    surface.albedo *= 1.0 - transmission;
    return passing;
#endif
}

#else

float cover_of(float alpha) { return alpha; }
vec3 take_passing(inout Surface surface) { return vec3(0.0); }

#endif
#else
layout(location = 0) out vec4 radiance;
#endif

void main() {
    vec4 colour = fragment_colour();
    Surface surfaces[SURFACES];
    uvec2 pixels[SURFACES];
    vec3 reflected[SURFACES];
    pixels[0] = uvec2(gl_FragCoord.xy);
    surfaces[0] = unpack_surface(fragment_surface(colour.rgb), gl_FragCoord.xyz, view.target_size, view.world_from_clip);
#ifdef GLOSSY
    set_gloss(surfaces[0], fragment_gloss());
#endif
#ifdef BUMPY
    set_bumps(surfaces[0], fragment_bumps());
#endif
#ifdef EMISSION
    vec3 emitted = part_first == 0u ? fragment_emission() : vec3(0.0);
#else
    const vec3 emitted = vec3(0.0);
#endif
    discard_hole(colour.a);
    if (gl_HelperInvocation) return;  // as in vpl_maps.frag: this shader may trace rays too
#ifdef BLENDED
    float alpha = cover_of(colour.a);
    vec3 passing = take_passing(surfaces[0]);
#ifdef GLOSSY
    surfaces[0].albedo *= alpha;  // what is reflected in the mirror direction does not fade
#endif
#endif
    reflect_radiance(surfaces, pixels, reflected);
#ifdef BLENDED
#if defined(GLOSSY) && !defined(SHOW_SURFACES)
    reflected[0] += alpha * emitted;
#else
    reflected[0] = alpha * (reflected[0] + emitted);
#endif
    cover = vec4(alpha * (1.0 - passing), 1.0);
#endif
    radiance = vec4(reflected[0], 1.0);
}
