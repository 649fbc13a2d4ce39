// Balances the form factors F. Each surfel i gets a scale dᵢ such that its row, Σ dᵢ Fᵢⱼ dⱼ over j, adds up to its
// covered share cᵢ, from surfel_cover.comp. Other surfels then gather from it the share cᵢ of the flux that it sends
// out. One round computes dᵢ ← √(dᵢ cᵢ / Σ Fᵢⱼ dⱼ) and halves the logarithm of the remaining error (after Sinkhorn and
// Knopp, 1967). See README.md, "Scaled form factors". One invocation per surfel.
#include "surfels/surfel.glsl"

layout(local_size_x = SURFEL_GROUP) in;

layout(std430, binding = BINDING_COVER) readonly restrict buffer Cover { uint cover[]; };
layout(std430, binding = BINDING_FORM_FACTORS) readonly restrict buffer FormFactors { uint form_factors[]; };
// Scale, and 1 - covered share. Two halves, written by the rounds in turn.
layout(std430, binding = BINDING_SURFEL_ROWS) restrict buffer Rows { vec2 rows[]; };

uniform uint round;

uniform float most_scale;  // largest product of the two scales of a factor, over column_stride

// Scale of a surfel after the previous round.
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
    float most = sqrt(most_scale * float(column_stride));
    float scale = sum > 0.0 ? min(sqrt(last_scale(id) * covered / sum), most) : 0.0;
    rows[(round % 2u) * surfel_count + id] = vec2(scale, 1.0 - covered);
}
