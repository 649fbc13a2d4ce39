// The VPLs that have depth maps: surfels (SURFELS), or traced VPLs, each in the slot of its index. Behind them follow the
// slots that surfels had in the last frame and have no more.
#include "bindings.glsl"
#include "types.glsl"
#include "vpls/vpl_constants.glsl"

struct MappedVpl {
    vec3 position;  // metres, on the surface
    vec3 normal;    // unit
    uint map;       // see vpl_atlas.glsl
};

struct MapTask {
    uint index;
    uint task;  // SURFEL_*
};

#ifdef SURFELS

layout(std430, binding = BINDING_SURFELS) readonly restrict buffer Surfels { Surfel surfels[]; };
// Index of a surfel or of a freed slot, and what is to be drawn there: SURFEL_CHANGED and the like.
layout(std430, binding = BINDING_MAP_TASKS) readonly restrict buffer MapTasks { uvec2 map_tasks[]; };

uniform bool has_tasks;  // else all maps are drawn, in the order of the surfels

bool is_freed(uint index) { return index >= vpl_constants.mapped; }

// All but those on deformed triangles without area, and freed slots.
bool has_map(uint index) { return !is_freed(index) && surfels[index].normal != vec3(0.0); }

MapTask map_task(uint turn) {
    return has_tasks ? MapTask(map_tasks[turn].x, map_tasks[turn].y) : MapTask(turn, SURFEL_WHOLE);
}

MappedVpl mapped_vpl(uint index) {
    if (is_freed(index)) return MappedVpl(vec3(0.0), vec3(0.0), index);
    return MappedVpl(surfels[index].position, surfels[index].normal, surfels[index].map);
}

#else

layout(std430, binding = BINDING_TRACED_VPLS) readonly restrict buffer TracedVpls { TracedVpl traced_vpls[]; };

bool has_map(uint index) { return traced_vpls[index].state == VPL_PLACED; }

MapTask map_task(uint turn) { return MapTask(turn, SURFEL_WHOLE); }

MappedVpl mapped_vpl(uint index) { return MappedVpl(traced_vpls[index].position, traced_vpls[index].normal, index); }

#endif
