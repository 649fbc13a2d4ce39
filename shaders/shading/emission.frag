// The radiance that a surface emits, to be added to what it reflects.
#include "surfaces/mesh_surface.glsl"

layout(location = 0) out vec4 radiance;

void main() {
    radiance = vec4(fragment_emission(), 1.0);
#ifdef MASKED
    discard_hole(fragment_colour().a);
#endif
}
