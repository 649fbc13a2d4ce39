// Depth only, with the holes of masks.
#include "mesh_surface.glsl"

void main() { fragment_colour(); }
