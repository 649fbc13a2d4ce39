// Shades a fragment as it is drawn, without a G-buffer.
#include "surfaces/mesh_surface.glsl"
#include "shading/lighting.glsl"
#include "view/view.glsl"

#ifdef BLENDED
// Dual-source blending computes radiance + (1 - cover) · background. Alpha is 1 where there is a surface.
layout(location = 0, index = 0) out vec4 radiance;
layout(location = 0, index = 1) out vec4 cover;
#else
layout(location = 0) out vec4 radiance;
#endif

void main() {
    vec4 colour = fragment_colour();
    if (gl_HelperInvocation) return;  // as in vpl_maps.frag: this shader may trace rays too
    Surface surfaces[SURFACES];
    uvec2 pixels[SURFACES];
    vec3 reflected[SURFACES];
    pixels[0] = uvec2(gl_FragCoord.xy);
    surfaces[0] = unpack_surface(fragment_surface(colour.rgb), gl_FragCoord.xyz, view.target_size, view.world_from_clip);
#ifdef GLOSSY
    set_gloss(surfaces[0], fragment_gloss());
#ifdef BLENDED
    surfaces[0].albedo *= colour.a;  // what is reflected in the mirror direction does not fade
#endif
#endif
#ifdef BUMPY
    set_bumps(surfaces[0], fragment_bumps());
#endif
    reflect_radiance(surfaces, pixels, reflected);
#ifdef BLENDED
    vec3 emitted = vec3(0.0);
#ifdef EMISSION
    emitted = fragment_emission();
#endif
#if defined(GLOSSY) && !defined(SHOW_SURFACES)
    reflected[0] += colour.a * emitted;
#else
    reflected[0] = colour.a * (reflected[0] + emitted);
#endif
    cover = vec4(colour.a);
#endif
    radiance = vec4(reflected[0], 1.0);
}
