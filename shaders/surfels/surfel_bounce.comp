// One bounce: surfels gather the light that others reflect. In the first dispatch (FIRST) that is the reflected flux of
// the lights, placed where it falls within each cell; later it is what the others have gathered and not sent on yet. One
// invocation per ROWS_A_BOUNCE surfels, or if SLICED, BOUNCE_SLICES per surfel.
#include "surfels/surfel_bounced.glsl"

#ifdef SLICED
layout(local_size_x = BOUNCE_GROUP, local_size_y = BOUNCE_SLICES) in;
#else
layout(local_size_x = BOUNCE_GROUP) in;
#endif

layout(std430, binding = BINDING_SURFELS) readonly restrict buffer Surfels { Surfel surfels[]; };
layout(std430, binding = BINDING_DIRECT_POINTS) readonly restrict buffer DirectPoints { DirectPoint direct_points[]; };
layout(std430, binding = BINDING_CELL_POINTS) readonly restrict buffer Points { CellPoint cell_points[]; };
layout(std430, binding = BINDING_FORM_FACTORS) readonly restrict buffer FormFactors { uint form_factors[]; };

// The rows of an invocation. They have the same columns, so that what a column sends is read once for all of them.
struct RowsHere {
    vec3 position[ROWS_A_BOUNCE];
    vec3 normal[ROWS_A_BOUNCE];
    vec3 sum[ROWS_A_BOUNCE];  // irradiance from the columns so far, without the rows' scales
};

#ifdef FIRST

// Irradiance from the flux of the lights that a cell reflects, before the scales.
vec3 from_lit_cell(vec3 position, vec3 normal, Surfel to, CellLight cell) {
    if (!is_near(to.position - position, to.width2)) {
        vec3 reflected = cell.direct - cell.emitted;
        return reflected / PI * disc_term(cell.centre, to.normal, cell.radius2, position, normal);
    }
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < to.point_count; ++i) {
        DirectPoint direct = direct_points[to.first_point + i];
        vec3 flux = direct.albedo * direct.arriving;
        if (flux == vec3(0.0)) continue;
        CellPoint point = cell_points[to.first_point + i];
        sum += flux / PI * disc_term(point.middle, point.normal, point.area / PI, position, normal);
    }
    return sum;
}

void add_column(inout RowsHere here, uint other, float factors[ROWS_A_BOUNCE]) {
    CellLight cell = cells[other];
    if (cell.direct == cell.emitted) return;
    Surfel to = surfels[other];
    float scale = rows[other].x;
    for (uint k = 0u; k < ROWS_A_BOUNCE; ++k) {
        if (factors[k] == 0.0) continue;
        here.sum[k] += scale * from_lit_cell(here.position[k], here.normal[k], to, cell);
    }
}

#else

void add_column(inout RowsHere here, uint other, float factors[ROWS_A_BOUNCE]) {
    vec4 sent = bounced[at_left(other)];
    for (uint k = 0u; k < ROWS_A_BOUNCE; ++k) here.sum[k] += factors[k] * sent.a * sent.rgb;
}

#endif

// Each slice has every BOUNCE_SLICES-th pair of columns; without slices, an invocation has all.
void gather(inout RowsHere here, uint first, uint apart) {
    for (uint i = gl_LocalInvocationID.y; i < columns / 2u; i += gl_WorkGroupSize.y) {
        float even[ROWS_A_BOUNCE];
        float odd[ROWS_A_BOUNCE];
        for (uint k = 0u; k < ROWS_A_BOUNCE; ++k) {
            uint id = min(first + k * apart, surfel_count - 1u);
            vec2 factors = unpackHalf2x16(form_factors[form_factors_at(id, i)]);
            even[k] = factors.x;
            odd[k] = factors.y;
        }
        uint other = surfel_of(first, 2u * i);
        if (other < surfel_count) add_column(here, other, even);
        other = surfel_of(first, 2u * i + 1u);
        if (other < surfel_count) add_column(here, other, odd);
    }
}

#ifdef SLICED

shared vec3 slices[BOUNCE_SLICES][BOUNCE_GROUP];

void add_slices(inout RowsHere here) {
    uint row = gl_LocalInvocationID.x;
    slices[gl_LocalInvocationID.y][row] = here.sum[0];
    memoryBarrierShared();
    barrier();
    here.sum[0] = vec3(0.0);
    for (uint i = 0u; i < BOUNCE_SLICES; ++i) here.sum[0] += slices[i][row];
}

#else

void add_slices(inout RowsHere here) {}

#endif

#ifdef FIRST

void keep_gathered(uint id, vec3 irradiance) {
    cells[id].indirect = irradiance;
    bounced[at_left(id)] = vec4(cells[id].albedo * irradiance, rows[id].x);
    bounced[at_step(id)] = vec4(0.0);
    bounced[at_step_gathered(id)] = vec4(0.0);
}

#else

void keep_gathered(uint id, vec3 irradiance) { bounced[at_gathered(id)] = vec4(irradiance, 0.0); }

#endif

void main() {
    uint first = gl_GlobalInvocationID.x;
    uint apart = bounce_rows_apart();
    RowsHere here;
    for (uint k = 0u; k < ROWS_A_BOUNCE; ++k) {
        uint id = min(first + k * apart, surfel_count - 1u);
        here.position[k] = surfels[id].position;
        here.normal[k] = surfels[id].normal;
        here.sum[k] = vec3(0.0);
    }
    if (first < apart) gather(here, first, apart);
    add_slices(here);
    if (first >= apart || gl_LocalInvocationID.y > 0u) return;
    for (uint k = 0u; k < ROWS_A_BOUNCE; ++k) {
        uint id = first + k * apart;
        if (id >= surfel_count) return;
        keep_gathered(id, rows[id].x * here.sum[k]);
    }
}
