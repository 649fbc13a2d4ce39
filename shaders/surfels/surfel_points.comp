// Finds which points of its cell a surfel sees. If a wall stands on the cell, light that falls behind the wall must not
// be sent on from in front of it: that would leak through the wall. One invocation per cell point.
#include "scene/bvh.glsl"
#include "scene/changed_boxes.glsl"
#include "surfels/surfel.glsl"

layout(local_size_x = SURFEL_GROUP) in;

layout(std430, binding = BINDING_SURFELS) readonly restrict buffer Surfels { Surfel surfels[]; };
layout(std430, binding = BINDING_CELL_POINTS) readonly restrict buffer Points { CellPoint cell_points[]; };
layout(std430, binding = BINDING_SEEN_POINTS) restrict buffer Seen { uint seen[]; };

uniform uint point_count;

const float LIFT = 0.25;  // of a cell's width; rays run this high above the surface, as it may be curved within a cell

void main() {
    uint id = gl_GlobalInvocationID.x;
    if (id >= point_count) return;
    CellPoint point = cell_points[id];
    Surfel surfel = surfels[point.surfel];
    float lift = LIFT * sqrt(surfel.area);
    vec3 origin = surfel.position + lift * surfel.normal;
    vec3 direction = point.position + lift * point.normal - origin;
    // If the cell itself has moved, its surface lies in a changed box, but the lifted ray may miss that box.
    bool moved = may_have_changed(surfel.position, point.position - surfel.position, 1.0);
    if (!moved && !may_have_changed(origin, direction, 1.0)) return;
    seen[id] = any_hit(origin, direction, 0.0, 1.0) ? 0u : 1u;
}
