// One bounce: surfels gather the light that others reflect. In the first dispatch (FIRST) that is the reflected flux of
// the lights, placed where it falls within each cell; later it is what the others gathered in the previous bounce. Adds
// to CellLight::indirect. One invocation per surfel.
#include "surfels/surfel.glsl"

layout(local_size_x = SURFEL_GROUP) in;

layout(std430, binding = BINDING_SURFELS) readonly restrict buffer Surfels { Surfel surfels[]; };
layout(std430, binding = BINDING_DIRECT_POINTS) readonly restrict buffer DirectPoints { DirectPoint direct_points[]; };
layout(std430, binding = BINDING_CELL_POINTS) readonly restrict buffer Points { CellPoint cell_points[]; };
layout(std430, binding = BINDING_FORM_FACTORS) readonly restrict buffer FormFactors { uint form_factors[]; };
// Scale, and 1 - covered share.
layout(std430, binding = BINDING_SURFEL_ROWS) readonly restrict buffer Rows { vec2 rows[]; };
layout(std430, binding = BINDING_CELL_LIGHT) restrict buffer Cells { CellLight cells[]; };
// Two parts in turn, for the previous bounce and this one: rgb is radiosity, a the surfel's scale. A third one for the
// irradiance of this bounce.
layout(std430, binding = BINDING_BOUNCE) restrict buffer Bounce { vec4 bounced[]; };

uniform uint bounce;  // 2 or more

// Irradiance from the flux of the lights that a cell reflects, before the scales.
vec3 from_lit_cell(Surfel from, uint other) {
    CellLight cell = cells[other];
    vec3 reflected = cell.direct - cell.emitted;
    if (reflected == vec3(0.0)) return vec3(0.0);
    Surfel to = surfels[other];
    if (!is_near(to.position - from.position, to.width2)) {
        return reflected / PI * disc_term(cell.centre, to.normal, cell.radius2, from.position, from.normal);
    }
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < to.point_count; ++i) {
        DirectPoint direct = direct_points[to.first_point + i];
        vec3 flux = direct.albedo * direct.arriving;
        if (flux == vec3(0.0)) continue;
        CellPoint point = cell_points[to.first_point + i];
        sum += flux / PI * disc_term(point.position, point.normal, point.area / PI, from.position, from.normal);
    }
    return sum;
}

// Irradiance from the surfel in a column, with that surfel's scale but without the row's.
vec3 from_column(Surfel from, uint row, uint column, float factor) {
    uint other = surfel_of(row, column);
    if (factor == 0.0) return vec3(0.0);
#ifdef FIRST
    return rows[other].x * from_lit_cell(from, other);
#else
    vec4 sent = bounced[(bounce % 2u) * surfel_count + other];
    return factor * sent.a * sent.rgb;
#endif
}

void main() {
    uint id = gl_GlobalInvocationID.x;
    if (id >= surfel_count) return;
    Surfel from = surfels[id];
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < columns / 2u; ++i) {
        vec2 factors = unpackHalf2x16(form_factors[form_factors_at(id, i)]);
        if (factors == vec2(0.0)) continue;
        sum += from_column(from, id, 2u * i, factors.x) + from_column(from, id, 2u * i + 1u, factors.y);
    }
    float scale = rows[id].x;
    vec3 irradiance = scale * sum;
    bounced[((bounce + 1u) % 2u) * surfel_count + id] = vec4(cells[id].albedo * irradiance, scale);
    bounced[2u * surfel_count + id] = vec4(irradiance, 0.0);
    cells[id].indirect += irradiance;
}
