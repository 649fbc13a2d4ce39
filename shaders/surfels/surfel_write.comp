// Turns surfels into VPLs: each has the total flux that its cell emits and reflects, and the position and width of the
// part of the cell that it comes from. Also writes the flux of each cell point. The last surfels are on surfaces that emit
// light. If `balanced`, surfels that stand for several items have the light of their own one only, and all have only what
// is more than the mean of the others: README.md, "Shared items". One invocation per surfel.
#include "surfels/surfel.glsl"

layout(local_size_x = SURFEL_GROUP) in;

layout(std430, binding = BINDING_SURFELS) readonly restrict buffer Surfels { Surfel surfels[]; };
layout(std430, binding = BINDING_LIT_SURFELS) restrict buffer LitSurfels { LitSurfel lit_surfels[]; };
layout(std430, binding = BINDING_DIRECT_POINTS) readonly restrict buffer DirectPoints { DirectPoint direct_points[]; };
layout(std430, binding = BINDING_CELL_POINTS) readonly restrict buffer Points { CellPoint cell_points[]; };
layout(std430, binding = BINDING_LIT_POINTS) writeonly restrict buffer LitPoints { LitPoint lit_points[]; };
layout(std430, binding = BINDING_LIT_EMITTERS) writeonly restrict buffer LitEmitters { LitEmitter lit_emitters[]; };
layout(std430, binding = BINDING_CELL_LIGHT) readonly restrict buffer Cells { CellLight cells[]; };

uniform float emitted_share;    // 1 if the VPLs show the light that surfaces emit, else 0
uniform float reflected_share;  // and the light that they reflect
uniform uint emitting_count;    // surfels that emit light
uniform bool balanced;
uniform uint mean_record;  // of surfel_mean.comp

// What of a cell is shown.
struct Shown {
    float own;  // share of its area
    vec3 mean;  // radiosity that is taken off
};

void write_points(Surfel surfel, vec3 indirect, Shown shown) {
    for (uint i = surfel.first_point; i < surfel.first_point + surfel.point_count; ++i) {
        CellPoint point = cell_points[i];
        DirectPoint direct = direct_points[i];
        vec3 reflected = direct.albedo * (direct.arriving + point.area * indirect);
        vec3 flux = emitted_share * direct.emitted + reflected_share * reflected - point.area * shown.mean;
        lit_points[i] = LitPoint(point.middle, shown.own * point.area, point.normal, 0.0, shown.own * flux, 0.0);
    }
}

// `spread`: flux of indirect light that the cell reflects, evenly over its area.
LitSurfel lit_surfel(Surfel surfel, CellLight cell, vec3 spread, vec3 flux) {
    vec3 centre = surfel.position;
    float radius2 = surfel.area / PI;
    float direct_weight = dot(cell.direct, vec3(1.0));
    float spread_weight = dot(spread, vec3(1.0));
    if (direct_weight + spread_weight > 0.0) {
        float share = direct_weight / (direct_weight + spread_weight);
        vec3 apart = cell.centre - surfel.position;
        centre += share * apart;
        // The direct light comes from one disc, the indirect light from another. One disc replaces both, with the mean
        // and the variance of the flux of both. See README.md, "Width of a lit cell".
        float between = share * (1.0 - share) * dot(apart, apart) * 6.0 / PI;
        radius2 = min(mix(radius2, cell.radius2, share) + between, radius2);
    }
    return LitSurfel(surfel.position, surfel.first_point, surfel.normal, surfel.point_count, centre, radius2, flux,
                     surfel.area, surfel.width2, surfel.map, 0.0, 0.0);
}

LitEmitter lit_emitter(Surfel surfel, vec3 flux) {
    return LitEmitter(surfel.position, surfel.first_point, surfel.normal, surfel.point_count, flux, surfel.area);
}

Shown shown_of(uint id) {
    if (!balanced || id >= surfel_count - emitting_count) return Shown(1.0, vec3(0.0));
    return Shown(surfels[id].own, lit_surfels[mean_record].flux);
}

void main() {
    uint id = gl_GlobalInvocationID.x;
    if (id >= surfel_count) return;
    Surfel surfel = surfels[id];
    CellLight cell = cells[id];
    Shown shown = shown_of(id);
    write_points(surfel, cell.indirect, shown);
    vec3 spread = cell.area * cell.albedo * cell.indirect;
    vec3 flux = emitted_share * cell.emitted + reflected_share * (cell.direct - cell.emitted + spread);
    uint first_emitter = surfel_count - emitting_count;
    if (id >= first_emitter) {
        lit_emitters[id - first_emitter] = lit_emitter(surfel, flux);
        return;
    }
    surfel.area *= shown.own;
    surfel.width2 *= shown.own;
    cell.radius2 *= shown.own;
    lit_surfels[id] = lit_surfel(surfel, cell, spread, shown.own * (flux - cell.area * shown.mean));
}
