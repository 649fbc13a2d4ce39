// Writes the visible surface to the G-buffer.
#include "surfaces/mesh_surface.glsl"

layout(location = 0) out vec2 packed_normal;
layout(location = 1) out vec4 albedo;
#ifdef GLOSSY
layout(location = 2) out vec4 mirror;
layout(location = 3) out vec2 gloss;
#endif
#ifdef BUMPY
#ifdef GLOSSY
layout(location = 4) out vec4 bumps;
#else
layout(location = 2) out vec4 bumps;
#endif
#endif

void main() {
    vec4 colour = fragment_colour();
    PackedSurface surface = fragment_surface(colour.rgb);
    packed_normal = surface.normal;
    albedo = vec4(surface.albedo, 1.0);
#ifdef GLOSSY
    PackedGloss packed_gloss = fragment_gloss();
    mirror = packed_gloss.mirror;
    gloss = packed_gloss.gloss;
#endif
#ifdef BUMPY
    PackedBumps packed_bumps = fragment_bumps();
    bumps = vec4(packed_bumps.normal, packed_bumps.open, 0.0);
#endif
    discard_hole(colour.a);
}
