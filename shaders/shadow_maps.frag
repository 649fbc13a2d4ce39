// Only for masked surfaces; the others need no fragment stage.
#include "mesh_surface.glsl"

void main() { fragment_colour(); }
