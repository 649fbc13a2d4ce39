// Writes depth, and with WITH_NORMALS also normals, packed as in the G-buffer. With MASKED it discards fragments in the
// holes of alpha masks.
#include "surfaces/mesh_surface.glsl"

#ifdef WITH_NORMALS
layout(location = 0) out vec2 packed_normal;
#endif

void main() {
    vec4 colour = fragment_colour();
#ifdef WITH_NORMALS
    packed_normal = fragment_surface(colour.rgb).normal;
#endif
    discard_hole(colour.a);
}
