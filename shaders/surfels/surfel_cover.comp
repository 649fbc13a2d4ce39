// Finds which share of a surfel's hemisphere is covered by reflecting surfaces, with COVER_PARTS · COVER_RAYS
// cosine-weighted rays. The form factors of the surfel's row should add up to it. A surfel keeps what its rays have
// found, unless it is to be traced. One work group per surfel, COVER_RAYS rays an invocation, which bounds its
// loops.
#include "maths.glsl"
#include "scene/bvh.glsl"
#include "scene/changed_boxes.glsl"
#include "sampling.glsl"
#include "surfels/surfel.glsl"
#include "surfels/surfel_tasks.glsl"

layout(local_size_x = COVER_PARTS) in;

layout(std430, binding = BINDING_SURFELS) readonly restrict buffer Surfels { Surfel surfels[]; };
layout(std430, binding = BINDING_COVER) writeonly restrict buffer Cover { uint cover[]; };

uniform float ray_offset;  // metres above the surface, where rays start

vec3 ray_direction(Surfel surfel, uint i) {
    return cosine_direction(surfel.normal, sample_2d(gl_LocalInvocationID.x * COVER_RAYS + i, 0u, surfel.seed));
}

bool is_outdated(uint id, Surfel surfel) {
    if (everything_changed || has_task(id, SURFEL_WHOLE | SURFEL_NO_FACTORS)) return true;
    if (changed_box_count == 0u || !has_task(id, SURFEL_CHANGED)) return false;
    for (uint i = 0u; i < COVER_RAYS; ++i) {
        if (may_have_changed(surfel.position, ray_direction(surfel, i), INFINITY)) return true;
    }
    return false;
}

void main() {
    uint id = gl_WorkGroupID.x + gl_NumWorkGroups.x * gl_WorkGroupID.y;
    if (id >= surfel_count) return;
    Surfel surfel = surfels[id];
    if (!is_outdated(id, surfel)) return;
    uint hits = 0u;
    uint rays = has_task(id, SURFEL_NO_FACTORS) ? 0u : COVER_RAYS;
    for (uint i = 0u; i < rays; ++i) {
        vec3 direction = ray_direction(surfel, i);
        Hit hit = closest_hit(surfel.position + ray_offset * surfel.normal, direction, 0.0, INFINITY);
        if (is_surface(hit, direction)) ++hits;
    }
    cover[id * COVER_PARTS + gl_LocalInvocationID.x] = hits;
}
