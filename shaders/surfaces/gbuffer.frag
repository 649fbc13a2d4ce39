// Writes the visible surface to the G-buffer.
#include "surfaces/mesh_surface.glsl"

layout(location = 0) out vec2 packed_normal;
layout(location = 1) out vec4 albedo;
#ifdef GLOSSY
layout(location = 2) out vec4 mirror;
layout(location = 3) out vec2 gloss;
#endif

void main() {
    PackedSurface surface = fragment_surface(fragment_colour().rgb);
    packed_normal = surface.normal;
    albedo = vec4(surface.albedo, 1.0);
#ifdef GLOSSY
    PackedGloss packed_gloss = fragment_gloss();
    mirror = packed_gloss.mirror;
    gloss = packed_gloss.gloss;
#endif
}
