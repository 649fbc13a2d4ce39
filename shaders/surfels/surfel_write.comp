// Turns surfels into VPLs: each has the total flux that its cell emits and reflects, and the position and width of the
// part of the cell that it comes from. Also writes the flux of each cell point. The patches of the sky (SKY) follow
// them. One invocation per surfel and patch.
#include "surfels/surfel.glsl"

layout(local_size_x = SURFEL_GROUP) in;

layout(std430, binding = BINDING_SURFELS) readonly restrict buffer Surfels { Vpl surfels[]; };
layout(std430, binding = BINDING_VPLS) writeonly restrict buffer Vpls { Vpl vpls[]; };
layout(std430, binding = BINDING_DIRECT_POINTS) readonly restrict buffer DirectPoints { DirectPoint direct_points[]; };
layout(std430, binding = BINDING_CELL_POINTS) readonly restrict buffer Points { CellPoint cell_points[]; };
layout(std430, binding = BINDING_LIT_POINTS) writeonly restrict buffer LitPoints { LitPoint lit_points[]; };
layout(std430, binding = BINDING_CELL_LIGHT) readonly restrict buffer Cells { CellLight cells[]; };

uniform float emitted_share;    // 1 if the VPLs show the light that surfaces emit, else 0
uniform float reflected_share;  // and the light that they reflect

#ifdef SKY

layout(std430, binding = BINDING_SKY_PATCHES) readonly restrict buffer SkyPatches { Vpl sky_patches[]; };

uniform uint sky_patch_count;

void write_patch(uint index) {
    if (index >= sky_patch_count) return;
    Vpl vpl = sky_patches[index];
    vpl.flux *= emitted_share;
    vpls[surfel_count + index] = vpl;
}

#else

void write_patch(uint index) {}

#endif

void main() {
    uint id = gl_GlobalInvocationID.x;
    if (id >= surfel_count) {
        write_patch(id - surfel_count);
        return;
    }
    Vpl vpl = surfels[id];
    CellLight cell = cells[id];
    for (uint i = vpl.first_point; i < vpl.first_point + vpl.point_count; ++i) {
        CellPoint point = cell_points[i];
        DirectPoint direct = direct_points[i];
        vec3 reflected = direct.albedo * (direct.arriving + direct.area * cell.indirect);
        vec3 flux = emitted_share * direct.emitted + reflected_share * reflected;
        lit_points[i] = LitPoint(point.position, point.area, point.normal, 0.0, flux, 0.0);
    }
    vec3 spread = cell.area * cell.albedo * cell.indirect;
    float direct_weight = dot(cell.direct, vec3(1.0));
    float spread_weight = dot(spread, vec3(1.0));
    if (direct_weight + spread_weight > 0.0) {
        float share = direct_weight / (direct_weight + spread_weight);
        vec3 apart = cell.centre - vpl.position;
        vpl.position += share * apart;
        // The direct light comes from one disc, the indirect light from another. Both are replaced by one disc, with
        // the mean and the variance of the flux of both. See theory.md, "Width of a lit cell".
        float between = share * (1.0 - share) * dot(apart, apart) * 6.0 / PI;
        vpl.radius2 = min(mix(vpl.radius2, cell.radius2, share) + between, vpl.radius2);
    }
    vpl.flux = emitted_share * cell.emitted + reflected_share * (cell.direct - cell.emitted + spread);
    vpls[id] = vpl;
}
