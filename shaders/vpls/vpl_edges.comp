// Finds the near edges of the surface that a VPL lies on: receivers beyond an edge do not stand on that surface, so
// there is no crease between them. Runs whenever VPLs are written, since the surroundings of a VPL may have moved even
// if it has not. One invocation per VPL and direction. See README.md, "Edges of a VPL's surface".
#include "bindings.glsl"
#include "maths.glsl"
#include "scene/bvh.glsl"
#include "types.glsl"

const uint DIRECTIONS = 6u;
const uint VPLS_A_GROUP = 16u;

layout(local_size_x = 6, local_size_y = 16) in;

layout(std430, binding = BINDING_TRACED_VPLS) restrict buffer TracedVpls { TracedVpl traced_vpls[]; };

uniform uint vpl_count;
uniform float edge_reach;  // metres: edges farther away are ignored

const float EDGE_RISE = 1.0 / 64.0;  // of edge_reach: a surface that bends away from the plane by less still continues
const int EDGE_BISECTIONS = 6;

// Distance in metres to the edge along a unit direction in the surface's plane, by bisection to within 1/128 of
// edge_reach. `above`: EDGE_RISE · edge_reach above the VPL. Infinite if there is no edge within edge_reach, or if the
// way to it is blocked by something that stands on the surface.
float edge_distance(vec3 above, vec3 along, vec3 normal) {
    float rise = EDGE_RISE * edge_reach;
    float near = 0.0;
    float far = closest_hit(above, along, 0.0, edge_reach).t - rise;
    float at = far;
    for (int i = 0; i <= EDGE_BISECTIONS; ++i) {
        bool goes_on = any_hit(above + at * along, -normal, 0.0, 2.0 * rise);
        if (i == 0 && (goes_on || far <= 0.0)) return INFINITY;
        if (goes_on) {
            near = at;
        } else {
            far = at;
        }
        at = 0.5 * (near + far);
    }
    return at;
}

// For a world axis, or its opposite, projected into the surface's plane: sin(axis, normal) / distance to the edge in
// that direction, in 1/m; 0 if there is no edge. For a straight edge e metres away, with normal m in the plane, the six
// values hold the components of m / e, whatever the plane's orientation. Axes within 18 degrees of the normal give 0.
float inverse_edge(TracedVpl vpl, uint direction) {
    uint axis = direction % 3u;
    vec3 along = -vpl.normal[axis] * vpl.normal;
    along[axis] += 1.0;
    float sine = length(along);
    if (sine < 0.3) return 0.0;
    vec3 above = vpl.position + EDGE_RISE * edge_reach * vpl.normal;
    return sine / edge_distance(above, (direction < 3u ? along : -along) / sine, vpl.normal);
}

shared float inverse_edges[VPLS_A_GROUP][DIRECTIONS];

void main() {
    uint id = gl_GlobalInvocationID.y;
    uint direction = gl_LocalInvocationID.x;
    bool alive = id < vpl_count && traced_vpls[min(id, vpl_count - 1u)].flux != vec3(0.0);
    if (alive) inverse_edges[gl_LocalInvocationID.y][direction] = inverse_edge(traced_vpls[id], direction);
    memoryBarrierShared();
    barrier();
    if (!alive || direction > 0u) return;
    float edges[DIRECTIONS] = inverse_edges[gl_LocalInvocationID.y];
    traced_vpls[id].edges_up = vec3(edges[0], edges[1], edges[2]);
    traced_vpls[id].edges_down = vec3(edges[3], edges[4], edges[5]);
}
