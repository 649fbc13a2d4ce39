// Moves what rays between surfels have found to the places that it has now: surfels that stay may have other indices. In
// their rows, factors that are not known become 0. Without a stride. One invocation per row and two columns, or per row
// and part of its cover; work groups: x along rows.
#include "surfels/surfel.glsl"
#include "surfels/surfel_kept.glsl"

layout(local_size_x = SURFEL_GROUP) in;

layout(std430, binding = BINDING_FORM_FACTORS) writeonly restrict buffer FormFactors { uint form_factors[]; };
layout(std430, binding = BINDING_COVER) writeonly restrict buffer Cover { uint cover[]; };
layout(std430, binding = BINDING_LAST_FORM_FACTORS) readonly restrict buffer LastFormFactors { uint last_form_factors[]; };
layout(std430, binding = BINDING_LAST_COVER) readonly restrict buffer LastCover { uint last_cover[]; };

uniform uint last_surfel_count;

float last_form_factor(uint row, uint column) {
    if (column >= surfel_count || kept[column] == NO_SURFEL) return 0.0;
    uint other = kept[column];
    vec2 factors = unpackHalf2x16(last_form_factors[other / 2u * last_surfel_count + row]);
    return other % 2u == 0u ? factors.x : factors.y;
}

void main() {
    uint row = gl_GlobalInvocationID.x;
    uint pair = gl_WorkGroupID.y;
    if (row >= surfel_count || kept[row] == NO_SURFEL) return;
    uint last = kept[row];
    if (pair < COVER_PARTS) cover[row * COVER_PARTS + pair] = last_cover[last * COVER_PARTS + pair];
    if (2u * pair >= columns) return;
    form_factors[form_factors_at(row, pair)] =
        packHalf2x16(vec2(last_form_factor(last, 2u * pair), last_form_factor(last, 2u * pair + 1u)));
}
