// Where the surface that a VPL sits on ends, as far as that is near: what lies beyond does not stand on it.
#include "bvh.glsl"

uniform float edge_reach;  // metres: how far edges are looked for

const float EDGE_RISE = 1.0 / 64.0;  // of edge_reach: by how much a surface may bend away and still go on
const int EDGE_BISECTIONS = 6;

// Distance in metres to the edge along a unit direction in the surface, from a place EDGE_RISE above it; infinite if there
// is none, or something that stands on the surface comes first.
float edge_distance(vec3 above, vec3 along, vec3 normal) {
    float rise = EDGE_RISE * edge_reach;
    float near = 0.0;
    float far = closest_hit(above, along, 0.0, edge_reach).t - rise;
    float at = far;
    for (int i = 0; i <= EDGE_BISECTIONS; ++i) {
        bool goes_on = any_hit(above + at * along, -normal, 0.0, 2.0 * rise);
        if (i == 0 && (goes_on || far <= 0.0)) return 1.0 / 0.0;
        if (goes_on) {
            near = at;
        } else {
            far = at;
        }
        at = 0.5 * (near + far);
    }
    return at;
}

// Edges in the directions of the world's axes and against them, each laid into the surface's plane: the inverse of the
// distance, times the sine of the angle between axis and normal. Of a straight edge e metres away, whose normal in the
// plane is m, these are m / e, whichever way the plane lies: their scalar product with a place in the plane, relative to
// the VPL, is 1 all along the edge. 0 where there is none; axes within 18 degrees of the normal say nothing.
void surface_edges(vec3 position, vec3 normal, out vec3 edges_up, out vec3 edges_down) {
    vec3 above = position + EDGE_RISE * edge_reach * normal;
    edges_up = edges_down = vec3(0.0);
    for (int k = 0; k < 6; ++k) {
        int axis = k / 2;
        vec3 along = -normal[axis] * normal;
        along[axis] += 1.0;
        float sine = length(along);
        if (sine < 0.3) continue;
        bool up = k % 2 == 0;
        float edge = sine / edge_distance(above, (up ? along : -along) / sine, normal);
        if (up) {
            edges_up[axis] = edge;
        } else {
            edges_down[axis] = edge;
        }
    }
}
