// The light that surfels have gathered from each other, bounce by bounce. OF_THE_GROUP: qualifier of what the invocations
// of a work group pass to each other.
#include "surfels/surfel.glsl"

#ifndef OF_THE_GROUP
#define OF_THE_GROUP
#endif

// Scale, and 1 - covered share.
layout(std430, binding = BINDING_SURFEL_ROWS) readonly restrict buffer Rows { vec2 rows[]; };
layout(std430, binding = BINDING_CELL_LIGHT) OF_THE_GROUP restrict buffer Cells { CellLight cells[]; };
// Two parts in turn, for the last bounce and the one before: rgb is radiosity, a the surfel's scale. A third one for the
// irradiance of the last bounce.
layout(std430, binding = BINDING_BOUNCE) OF_THE_GROUP restrict buffer Bounce { vec4 bounced[]; };

// Where the light of this bounce is, and that of the one before.
uint at_last(uint bounce, uint id) { return (bounce + 1u) % 2u * surfel_count + id; }
uint at_previous(uint bounce, uint id) { return bounce % 2u * surfel_count + id; }

// `sum`: what the surfel gathers in this bounce, without its own scale.
void add_bounce(uint bounce, uint id, vec3 sum) {
    float scale = rows[id].x;
    vec3 irradiance = scale * sum;
    bounced[at_last(bounce, id)] = vec4(cells[id].albedo * irradiance, scale);
    bounced[2u * surfel_count + id] = vec4(irradiance, 0.0);
    cells[id].indirect += irradiance;
}
