// How much an error in the light of each surfel is seen. The flux of its cell is carried along the form factors to those
// that are seen, each time relative to the light that arrives there; the squares add up: README.md, "Guide". First
// (`receives`) one invocation for each cell that may be seen, then one for each that sends light.
#include "surfels/surfel.glsl"

layout(local_size_x = SURFEL_GROUP) in;

layout(std430, binding = BINDING_FORM_FACTORS) readonly restrict buffer FormFactors { uint form_factors[]; };
layout(std430, binding = BINDING_SURFEL_ROWS) readonly restrict buffer Rows { vec2 rows[]; };  // x: scale
layout(std430, binding = BINDING_LIT_SURFELS) readonly restrict buffer LitSurfels { LitSurfel lit_surfels[]; };
// By surfel: number of rays from the eyes that meet its cell; after the first step, the root of that over the irradiance
// there.
layout(std430, binding = BINDING_SEEN_SURFELS) restrict buffer Seen { float seen[]; };
layout(std430, binding = BINDING_GUIDE) writeonly restrict buffer Guide { float shares[]; };  // by surfel, in any unit

uniform uint sending_count;  // surfels that send light: the first ones
uniform bool receives;

float factor(uint row, uint column) {
    vec2 factors = unpackHalf2x16(form_factors[form_factors_at(row, column / 2u)]);
    return rows[row].x * rows[column].x * factors[column % 2u];
}

void receive(uint id) {
    if (id >= surfel_count || seen[id] == 0.0) return;
    float irradiance = 0.0;
    for (uint i = 0u; i < sending_count; ++i) {
        LitSurfel from = lit_surfels[i];
        if (from.area > 0.0) irradiance += factor(id, i) * dot(from.flux, vec3(1.0)) / from.area;
    }
    seen[id] = irradiance > 0.0 ? sqrt(seen[id]) / irradiance : 0.0;
}

void send(uint id) {
    if (id >= sending_count) return;
    float squares = 0.0;
    for (uint i = 0u; i < surfel_count; ++i) {
        if (seen[i] == 0.0) continue;
        float carried = seen[i] * factor(i, id);
        squares += carried * carried;
    }
    LitSurfel own = lit_surfels[id];
    shares[id] = own.area > 0.0 ? sqrt(squares) * dot(own.flux, vec3(1.0)) / own.area : 0.0;
}

void main() {
    if (receives) {
        receive(gl_GlobalInvocationID.x);
    } else {
        send(gl_GlobalInvocationID.x);
    }
}
