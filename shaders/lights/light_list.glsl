// Which lights a surface evaluates: all of them, or the list of its cell (LIGHT_LIST_CELLS).
#include "bindings.glsl"
#include "lights/light_cells.glsl"
#include "lights/light_constants.glsl"
#include "types.glsl"
#include "view/view.glsl"

#ifdef LIGHT_LIST_CELLS

layout(std430, binding = BINDING_LIST_FIRST) readonly restrict buffer ListFirst { uint list_first[]; };
layout(std430, binding = BINDING_LIST_COUNT) readonly restrict buffer ListCount { uint list_count[]; };
layout(std430, binding = BINDING_LIST_ENTRIES) readonly restrict buffer ListEntries { uint list_entries[]; };

// Number of entries at the start of the buffer that belong to every cell's list. The first cell's own list follows them.
uint global_light_count() { return list_first[0]; }

struct LightListRange {
    uint first;
    uint size;
};

// The list for a surface at a pixel; `position` in world space, metres.
LightListRange light_list_at(uvec2 pixel, vec3 position) {
    float depth = grid.slices > 1u ? -(view.view_from_world * vec4(position, 1.0)).z : 0.0;
    uint cell = cell_index(pixel / grid.tile_size, grid.slices > 1u ? slice_of(depth) : 0u);
    return LightListRange(list_first[cell], global_light_count() + list_count[cell]);
}

uint light_list_entry(LightListRange list, uint i) {
    return list_entries[i < global_light_count() ? i : list.first + i - global_light_count()];
}

#else

struct LightListRange {
    uint size;
};

LightListRange light_list_at(uvec2 pixel, vec3 position) { return LightListRange(light_constants.count); }
uint light_list_entry(LightListRange list, uint i) { return i; }

#endif
