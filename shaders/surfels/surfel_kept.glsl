// Surfels that the last frame in which rays were traced between them had as well: at the same place, with the same cell.
#include "bindings.glsl"

// By surfel: its index in that frame, or NO_SURFEL. Not there if everything has changed.
layout(std430, binding = BINDING_KEPT_SURFELS) readonly restrict buffer Kept { uint kept[]; };
