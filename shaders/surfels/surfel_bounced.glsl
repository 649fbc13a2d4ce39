// The light that surfels have gathered from each other, bounce by bounce. OF_THE_GROUP: qualifier of what the invocations
// of a work group pass to each other.
#include "surfels/surfel.glsl"

#ifndef OF_THE_GROUP
#define OF_THE_GROUP
#endif

// Scale, and 1 - covered share.
layout(std430, binding = BINDING_SURFEL_ROWS) readonly restrict buffer Rows { vec2 rows[]; };
layout(std430, binding = BINDING_CELL_LIGHT) OF_THE_GROUP restrict buffer Cells { CellLight cells[]; };
// Four parts of a value a surfel: the radiosity that no surfel has gathered yet, with the surfel's scale in a; the irradiance
// of the last bounce; the radiosity of the last step, and the irradiance that others have gathered from it.
layout(std430, binding = BINDING_BOUNCE) OF_THE_GROUP restrict buffer Bounce { vec4 bounced[]; };

uint at_left(uint id) { return id; }
uint at_gathered(uint id) { return surfel_count + id; }
uint at_step(uint id) { return 2u * surfel_count + id; }
uint at_step_gathered(uint id) { return 3u * surfel_count + id; }
