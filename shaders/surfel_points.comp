// Which points of its cell a surfel sees. Where a wall stands on a cell, what lies behind it is not the surfel's to send
// on: it would shine through. One invocation a point.
#include "bvh.glsl"
#include "changed_boxes.glsl"
#include "surfel.glsl"

layout(local_size_x = SURFEL_GROUP) in;

layout(std430, binding = BINDING_SURFELS) readonly restrict buffer Surfels { Vpl surfels[]; };
layout(std430, binding = BINDING_CELL_POINTS) readonly restrict buffer Points { CellPoint cell_points[]; };
layout(std430, binding = BINDING_SEEN_POINTS) restrict buffer Seen { uint seen[]; };

uniform uint point_count;

const float LIFT = 0.25;  // of a cell's width: above what the surface of a cell bends

void main() {
    uint id = gl_GlobalInvocationID.x;
    if (id >= point_count) return;
    CellPoint point = cell_points[id];
    Vpl surfel = surfels[point.surfel];
    float lift = LIFT * sqrt(surfel.area);
    vec3 origin = surfel.position + lift * surfel.normal;
    vec3 direction = point.position + lift * point.normal - origin;
    // What has moved by itself lies in a changed box, though what is lifted off it may not.
    bool moved = may_have_changed(surfel.position, point.position - surfel.position, 1.0);
    if (!moved && !may_have_changed(origin, direction, 1.0)) return;
    seen[id] = any_hit(origin, direction, 0.0, 1.0) ? 0u : 1u;
}
