// Scales a surfel's row of form factors to what it sees of reflecting surfaces. One invocation a surfel.
#include "surfel.glsl"

layout(local_size_x = SURFEL_GROUP) in;

layout(std430, binding = BINDING_COVER) readonly restrict buffer Cover { uint cover[]; };
layout(std430, binding = BINDING_FORM_FACTORS) readonly restrict buffer FormFactors { uint form_factors[]; };
layout(std430, binding = BINDING_SURFEL_ROWS) writeonly restrict buffer Rows { vec2 rows[]; };  // scale, open share

const float MOST_SCALE = 2.0;

void main() {
    uint id = gl_GlobalInvocationID.x;
    if (id >= surfel_count) return;
    uint hits = 0u;
    for (uint i = 0u; i < COVER_PARTS; ++i) hits += cover[id * COVER_PARTS + i];
    float covered = float(hits) / float(COVER_PARTS * COVER_RAYS);
    float sum = 0.0;
    for (uint i = 0u; i < columns / 2u; ++i) {
        vec2 factors = unpackHalf2x16(form_factors[id * (columns / 2u) + i]);
        sum += factors.x + factors.y;
    }
    float scale = sum > 0.0 ? min(covered / sum, MOST_SCALE * float(column_stride)) : 0.0;
    rows[id] = vec2(scale, 1.0 - covered);
}
