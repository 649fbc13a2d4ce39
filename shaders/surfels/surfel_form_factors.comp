// Form factors: the share of a surfel's cosine-weighted hemisphere that the cell in each column fills, 0 where a ray
// finds the other surfel hidden. Pairs keep theirs, unless they are to be traced. One
// invocation per row and two columns; work groups: x along rows, y along pairs of columns, of all or of those that are
// listed.
#include "scene/bvh.glsl"
#include "scene/changed_boxes.glsl"
#include "surfels/surfel.glsl"
#include "surfels/surfel_tasks.glsl"

layout(local_size_x = SURFEL_GROUP) in;

layout(std430, binding = BINDING_SURFELS) readonly restrict buffer Surfels { Surfel surfels[]; };
layout(std430, binding = BINDING_CELL_POINTS) readonly restrict buffer Points { CellPoint cell_points[]; };
layout(std430, binding = BINDING_FORM_FACTORS) restrict buffer FormFactors { uint form_factors[]; };

// Indices of rows, then of pairs of columns.
layout(std430, binding = BINDING_LISTED_SURFELS) readonly restrict buffer Listed { uint listed[]; };

uniform uint listed_rows;   // number of them; 0: all rows
uniform uint listed_pairs;  // number of them; 0: all pairs
uniform uint first_pair;    // place of the first pair in the list
uniform float ray_offset;  // metres above both surfaces, where rays start and end

float form_factor(Surfel from, Surfel to) {
    if (!is_near(to.position - from.position, to.width2)) {
        return to.area / PI * disc_term(to.position, to.normal, to.area / PI, from.position, from.normal);
    }
    float sum = 0.0;
    for (uint i = 0u; i < to.point_count; ++i) {
        CellPoint point = cell_points[to.first_point + i];
        sum += point.area / PI * disc_term(point.middle, point.normal, point.area / PI, from.position, from.normal);
    }
    return sum;
}

// Between the surfels themselves: light then leaves from where it has arrived. With the mean over both cells in place of
// one ray, it would be spread to parts that see other rooms: in a row of them, the third would be 1.5 times too bright.
bool sees(Surfel from, Surfel to) {
    vec3 origin = from.position + ray_offset * from.normal;
    vec3 target = to.position + ray_offset * to.normal;
    return !any_hit(origin, target - origin, 0.0, 1.0);
}

bool has_surfel(uint row, uint column) { return column < columns && surfel_of(row, column) < surfel_count; }

// Whether the factor that is there still holds.
bool pair_stays(uint row, uint column) {
    if (everything_changed || has_task(row, SURFEL_WHOLE | SURFEL_NO_FACTORS)) return false;
    if (!has_surfel(row, column)) return true;
    uint other = surfel_of(row, column);
    if (has_task(other, SURFEL_COLUMN | SURFEL_NO_FACTORS)) return false;
    if (!has_task(row, SURFEL_CHANGED)) return true;
    vec3 from = surfels[row].position;
    return !may_have_changed(from, surfels[other].position - from, 1.0);
}

float visible_form_factor(uint row, uint column) {
    uint other = surfel_of(row, column);
    if (!has_surfel(row, column) || other == row) return 0.0;
    if (has_task(row, SURFEL_NO_FACTORS) || has_task(other, SURFEL_NO_FACTORS)) return 0.0;
    Surfel from = surfels[row];
    Surfel to = surfels[other];
    float factor = form_factor(from, to);
    return factor > 0.0 && sees(from, to) ? factor : 0.0;
}

void main() {
    if (gl_GlobalInvocationID.x >= (listed_rows > 0u ? listed_rows : surfel_count)) return;
    uint row = listed_rows > 0u ? listed[gl_GlobalInvocationID.x] : gl_GlobalInvocationID.x;
    uint pair = listed_pairs > 0u ? listed[first_pair + gl_WorkGroupID.y] : gl_WorkGroupID.y;
    if (2u * pair >= columns) return;
    uint place = form_factors_at(row, pair);
    vec2 factors = unpackHalf2x16(form_factors[place]);
    bool all_stay = true;
    // A loop has the code for rays, which takes drivers long to compile, only once.
    for (uint i = 0u; i < 2u; ++i) {
        uint column = 2u * pair + i;
        if (pair_stays(row, column)) continue;
        factors[i] = visible_form_factor(row, column);
        all_stay = false;
    }
    if (!all_stay) form_factors[place] = packHalf2x16(factors);
}
