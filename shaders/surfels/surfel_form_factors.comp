// Form factors: the share of a surfel's cosine-weighted hemisphere that the cell in each column fills, 0 where a ray
// finds the other surfel hidden. One invocation per row and two columns; work groups: x along rows, y along pairs of
// columns.
#include "scene/bvh.glsl"
#include "scene/changed_boxes.glsl"
#include "surfels/surfel.glsl"

layout(local_size_x = SURFEL_GROUP) in;

layout(std430, binding = BINDING_SURFELS) readonly restrict buffer Surfels { Surfel surfels[]; };
layout(std430, binding = BINDING_CELL_POINTS) readonly restrict buffer Points { CellPoint cell_points[]; };
layout(std430, binding = BINDING_FORM_FACTORS) restrict buffer FormFactors { uint form_factors[]; };

uniform float ray_offset;  // metres above both surfaces, where rays start and end

float form_factor(Surfel from, Surfel to) {
    if (!is_near(to.position - from.position, to.area)) {
        return to.area / PI * disc_term(to.position, to.normal, to.radius2, from.position, from.normal);
    }
    float sum = 0.0;
    for (uint i = 0u; i < to.point_count; ++i) {
        CellPoint point = cell_points[to.first_point + i];
        sum += point.area / PI * disc_term(point.position, point.normal, point.area / PI, from.position, from.normal);
    }
    return sum;
}

bool sees(Surfel from, Surfel to) {
    vec3 origin = from.position + ray_offset * from.normal;
    vec3 target = to.position + ray_offset * to.normal;
    return !any_hit(origin, target - origin, 0.0, 1.0);
}

bool pair_may_have_changed(uint row, uint column) {
    uint other = surfel_of(row, column);
    if (column >= columns || other >= surfel_count) return everything_changed;
    vec3 from = surfels[row].position;
    return may_have_changed(from, surfels[other].position - from, 1.0);
}

float visible_form_factor(uint row, uint column) {
    uint other = surfel_of(row, column);
    if (column >= columns || other >= surfel_count || other == row) return 0.0;
    Surfel from = surfels[row];
    Surfel to = surfels[other];
    float factor = form_factor(from, to);
    return factor > 0.0 && sees(from, to) ? factor : 0.0;
}

void main() {
    uint row = gl_GlobalInvocationID.x;
    uint pair = gl_WorkGroupID.y;
    if (2u * pair >= columns || row >= surfel_count) return;
    if (!pair_may_have_changed(row, 2u * pair) && !pair_may_have_changed(row, 2u * pair + 1u)) return;
    vec2 factors = vec2(visible_form_factor(row, 2u * pair), visible_form_factor(row, 2u * pair + 1u));
    form_factors[form_factors_at(row, pair)] = packHalf2x16(factors);
}
