// Depth only, with the holes of masks. The shadow maps of masked surfaces are drawn with it too.
#include "mesh_surface.glsl"

void main() { fragment_colour(); }
