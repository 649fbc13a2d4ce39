// Mean radiosity of the items that have no surfels of their own, as those show it that stand for them. It is written as
// the flux of a record behind those of surfels. See README.md, "Shared items". One work group in all; an
// invocation adds up every SURFEL_GROUP-th cell.
#include "surfels/surfel.glsl"

layout(local_size_x = SURFEL_GROUP) in;

layout(std430, binding = BINDING_SURFELS) readonly restrict buffer Surfels { Surfel surfels[]; };
layout(std430, binding = BINDING_CELL_LIGHT) readonly restrict buffer Cells { CellLight cells[]; };
layout(std430, binding = BINDING_LIT_SURFELS) restrict buffer LitSurfels { LitSurfel lit_surfels[]; };

uniform uint reflecting_count;  // surfels on surfaces that emit no light
uniform uint mean_record;
uniform float reflected_share;  // see surfel_write.comp

shared vec3 fluxes[SURFEL_GROUP];
shared float areas[SURFEL_GROUP];

void main() {
    uint lane = gl_LocalInvocationID.x;
    vec3 flux = vec3(0.0);
    float area = 0.0;
    for (uint id = lane; id < reflecting_count; id += SURFEL_GROUP) {
        CellLight cell = cells[id];
        float of_others = 1.0 - surfels[id].own;
        flux += of_others * (cell.direct + cell.area * cell.albedo * cell.indirect);
        area += of_others * cell.area;
    }
    fluxes[lane] = flux;
    areas[lane] = area;
    memoryBarrierShared();
    barrier();
    if (lane > 0u) return;
    for (uint i = 1u; i < SURFEL_GROUP; ++i) {
        flux += fluxes[i];
        area += areas[i];
    }
    lit_surfels[mean_record].flux = area > 0.0 ? reflected_share / area * flux : vec3(0.0);
}
