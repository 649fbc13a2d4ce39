// Depth, with the holes of masks, and (WITH_NORMALS) normals as in the G-buffer. The shadow maps of masked surfaces are
// drawn with it too.
#include "mesh_surface.glsl"

#ifdef WITH_NORMALS
layout(location = 0) out vec2 packed_normal;
#endif

void main() {
    vec4 colour = fragment_colour();
#ifdef WITH_NORMALS
    packed_normal = fragment_surface(colour.rgb).normal;
#endif
}
