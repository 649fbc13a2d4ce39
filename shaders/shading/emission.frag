// The radiance that a surface emits, to be added to what it reflects.
#include "surfaces/mesh_surface.glsl"

layout(location = 0) out vec4 radiance;

void main() {
#ifdef MASKED
    fragment_colour();  // discards holes
#endif
    radiance = vec4(fragment_emission(), 1.0);
}
