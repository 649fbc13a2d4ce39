// Culls the light list of a cell in place: lights that reach the cell are kept, in their order. One invocation per cell, or
// with GROUP_A_CELL one work group.
#include "bindings.glsl"
#include "lights/light_cells.glsl"
#include "lights/lights.glsl"
#include "types.glsl"
#include "view/view.glsl"
#include "loop_part.glsl"

layout(local_size_x = CULL_GROUP) in;

layout(std430, binding = BINDING_LIST_FIRST) readonly restrict buffer ListFirst { uint list_first[]; };
layout(std430, binding = BINDING_LIST_COUNT) restrict buffer ListCount { uint list_count[]; };
#ifdef GROUP_A_CELL
#define OF_THE_GROUP coherent
#else
#define OF_THE_GROUP
#endif
layout(std430, binding = BINDING_LIST_ENTRIES) OF_THE_GROUP restrict buffer ListEntries { uint list_entries[]; };

// The part of view space that a cell covers: rays between `lower` and `upper` (view-space x and y at depth 1;
// orthographic: at any depth), between two depths in metres, and there only the slices whose bit is set in the mask.
struct Cell {
    vec2 lower;
    vec2 upper;
    float nearest;
    float farthest;
    uint mask;  // 32 slices between nearest and farthest
};

Cell make_cell(uvec2 tile, float nearest, float farthest, uint mask) {
    vec2 low = vec2(tile * grid.tile_size) / vec2(grid.target_size);
    vec2 high = vec2((tile + 1u) * grid.tile_size) / vec2(grid.target_size);
    vec2 lower = (low * 2.0 - 1.0 - view.ray_shift) * view.ray_scale;
    vec2 upper = (high * 2.0 - 1.0 - view.ray_shift) * view.ray_scale;
    return Cell(lower, upper, nearest, farthest, mask);
}

struct Bounds {
    vec3 centre;  // view space, z towards the viewer
    vec3 half_extent;
};

// View-space bounding box of the part of the cell between depths a and b.
Bounds box_between(Cell cell, float a, float b) {
    vec2 scale = view.orthographic != 0u ? vec2(1.0) : vec2(a, b);
    vec2 low = min(cell.lower * scale.x, cell.lower * scale.y);
    vec2 high = max(cell.upper * scale.x, cell.upper * scale.y);
    return Bounds(vec3(low + high, -(a + b)) * 0.5, vec3(high - low, b - a) * 0.5);
}

// Whether a sphere lies wholly outside one of the four side planes: its signed distance, positive inside the cell, is
// less than -radius.
bool outside_planes(Cell cell, vec3 centre, float radius) {
    vec2 depth = view.orthographic != 0u ? vec2(1.0) : vec2(-centre.z);
    vec2 low = centre.xy - cell.lower * depth;
    vec2 high = cell.upper * depth - centre.xy;
    if (view.orthographic == 0u) {
        low *= inversesqrt(1.0 + cell.lower * cell.lower);
        high *= inversesqrt(1.0 + cell.upper * cell.upper);
    }
    return any(lessThan(low, vec2(-radius))) || any(lessThan(high, vec2(-radius)));
}

// Whether the bounding sphere of a box lies wholly outside a cone, to the side of it or behind it. Conservative: behind
// the apex it may miss that the sphere is outside.
bool outside_cone(Bounds box, vec3 apex, vec3 axis, float cos_angle) {
    float radius = length(box.half_extent);
    vec3 from_apex = box.centre - apex;
    float along = dot(from_apex, axis);
    float across = sqrt(max(dot(from_apex, from_apex) - along * along, 0.0));
    float sin_angle = sqrt(max(1.0 - cos_angle * cos_angle, 0.0));
    return cos_angle * across - sin_angle * along > radius;
}

// Whether the light's range may overlap the cell. Conservative: never false where the light's irradiance in the cell is
// not zero. See README.md, "Light culling".
bool reaches(Light light, Cell cell) {
    if (isinf(light.range)) return true;
    vec3 centre = (view.view_from_world * vec4(light.position, 1.0)).xyz;
    // Enlarged by the rounding error of the centre.
    float radius = light.range * 1.0001 + 1e-6 * (length(centre) + length(light.position));
    float nearest = max(cell.nearest, -centre.z - radius);
    float farthest = min(cell.farthest, -centre.z + radius);
    if (nearest > farthest) return false;
    if ((slices_between(cell.nearest, cell.farthest, nearest, farthest) & cell.mask) == 0u) return false;
    if (outside_planes(cell, centre, radius)) return false;
    Bounds box = box_between(cell, nearest, farthest);
    vec3 gap = max(abs(centre - box.centre) - box.half_extent * 1.0001, 0.0);
    if (dot(gap, gap) > radius * radius) return false;
    float cos_cone = bounding_cone(light);
    if (cos_cone <= -1.0) return true;
    vec3 axis = mat3(view.view_from_world) * light.direction;
    return !outside_cone(box, centre, axis, cos_cone);
}

#ifdef GROUP_A_CELL

uint cell_here() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }

shared uint reaching[CULL_GROUP / 32u];  // a bit for each invocation

// Number of invocations before the first `lanes` ones whose light reaches the cell.
uint reaching_before(uint lanes) {
    uint count = 0u;
    for (uint i = 0u; 32u * i < lanes; ++i) {
        uint here = lanes - 32u * i;
        count += uint(bitCount(here < 32u ? reaching[i] & ((1u << here) - 1u) : reaching[i]));
    }
    return count;
}

// Tests as many entries of list `index` at a time as there are invocations.
void cull(uint index, Cell cell) {
    uint lane = gl_LocalInvocationID.x;
    uint first = list_first[index];
    uint end = list_first[index + 1u];
    uint kept = first;
    for (uint i = first; i < end; i += CULL_GROUP) {
        uint light = list_entries[min(i + lane, end - 1u)];
        bool is_kept = i + lane < end && reaches(lights[light], cell);
        if (lane < CULL_GROUP / 32u) reaching[lane] = 0u;
        memoryBarrierBuffer();
        memoryBarrierShared();
        barrier();
        if (is_kept) atomicOr(reaching[lane / 32u], 1u << (lane % 32u));
        memoryBarrierShared();
        barrier();
        // No later turn reads these places.
        if (is_kept) list_entries[kept + reaching_before(lane)] = light;
        kept += reaching_before(CULL_GROUP);
        memoryBarrierShared();
        barrier();
    }
    if (lane == 0u) list_count[index] = kept - first;
}

#else

uint cell_here() { return gl_GlobalInvocationID.x; }

// Tests the entries of list `index` in this part of the loop. Those that reach the cell are moved behind the entries
// that earlier dispatches kept.
void cull(uint index, Cell cell) {
    uint first = list_first[index];
    uint begin = first + part_first;
    uint end = min(list_first[index + 1u], begin + part_size);
    uint kept = part_first == 0u ? first : first + list_count[index];
    for (uint i = begin; i < end; ++i) {
        uint light = list_entries[i];
        if (reaches(lights[light], cell)) list_entries[kept++] = light;
    }
    list_count[index] = kept - first;
}

#endif
