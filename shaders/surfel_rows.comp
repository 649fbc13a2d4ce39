// Scales form factors, so that a surfel's row comes to what it sees of reflecting surfaces, and what others gather from it
// comes to what it sends them: the factor of row and column is multiplied by the scales of both. As areas times factors are
// symmetric but for the discs' shapes, one scale a surfel does both (Sinkhorn and Knopp, "Concerning nonnegative matrices
// and doubly stochastic matrices", 1967); a round halves the logarithm of what is left to scale. One invocation a surfel.
#include "surfel.glsl"

layout(local_size_x = SURFEL_GROUP) in;

layout(std430, binding = BINDING_COVER) readonly restrict buffer Cover { uint cover[]; };
layout(std430, binding = BINDING_FORM_FACTORS) readonly restrict buffer FormFactors { uint form_factors[]; };
layout(std430, binding = BINDING_SURFEL_ROWS) restrict buffer Rows { vec2 rows[]; };  // scale, open share; of two rounds

uniform uint round;

const float MOST_SCALE = 2.0;  // of a factor

float last_scale(uint surfel) {
    if (round == 0u || surfel >= surfel_count) return 1.0;
    return rows[((round + 1u) % 2u) * surfel_count + surfel].x;
}

void main() {
    uint id = gl_GlobalInvocationID.x;
    if (id >= surfel_count) return;
    uint hits = 0u;
    for (uint i = 0u; i < COVER_PARTS; ++i) hits += cover[id * COVER_PARTS + i];
    float covered = float(hits) / float(COVER_PARTS * COVER_RAYS);
    float sum = 0.0;
    for (uint i = 0u; i < columns / 2u; ++i) {
        vec2 factors = unpackHalf2x16(form_factors[form_factors_at(id, i)]);
        sum += dot(factors, vec2(last_scale(surfel_of(id, 2u * i)), last_scale(surfel_of(id, 2u * i + 1u))));
    }
    float most = sqrt(MOST_SCALE * float(column_stride));
    float scale = sum > 0.0 ? min(sqrt(last_scale(id) * covered / sum), most) : 0.0;
    rows[(round % 2u) * surfel_count + id] = vec2(scale, 1.0 - covered);
}
