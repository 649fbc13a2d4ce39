// Where the surface that a VPL sits on ends, as far as that is near. Of a surface that goes on nothing tells where to.
#include "bvh.glsl"

uniform float edge_reach;  // metres: how far edges are looked for

const float EDGE_RISE = 1.0 / 32.0;  // of edge_reach: by how much a surface may bend away and still go on
const int EDGE_BISECTIONS = 4;

// Whether the plane of a VPL's surface is solid underneath a place above it.
bool is_above_surface(vec3 place, vec3 normal) {
    return any_hit(place, -normal, 0.0, 2.0 * EDGE_RISE * edge_reach);
}

// Distance in metres to the edge along a unit direction in the surface; infinite if there is none, or something that
// stands on the surface comes first.
float edge_distance(vec3 above, vec3 along, vec3 normal) {
    float far = closest_hit(above, along, 0.0, edge_reach).t - EDGE_RISE * edge_reach;
    if (far <= 0.0 || is_above_surface(above + far * along, normal)) return 1.0 / 0.0;
    float near = 0.0;
    for (int i = 0; i < EDGE_BISECTIONS; ++i) {
        float middle = 0.5 * (near + far);
        if (is_above_surface(above + middle * along, normal)) {
            near = middle;
        } else {
            far = middle;
        }
    }
    return far;
}

// Edges in the directions of the world's axes, or against them (`side` -1), each laid into the surface's plane: of a place
// at the edge in one of them, relative to the VPL, that coordinate's inverse; 0 where there is no edge. Axes within 18
// degrees of the normal say nothing.
vec3 surface_edges(vec3 position, vec3 normal, float side) {
    vec3 above = position + EDGE_RISE * edge_reach * normal;
    vec3 edges = vec3(0.0);
    for (int axis = 0; axis < 3; ++axis) {
        vec3 along = -normal[axis] * normal;
        along[axis] += 1.0;
        float steepness = length(along);
        if (steepness < 0.3) continue;
        edges[axis] = 1.0 / (steepness * edge_distance(above, side * along / steepness, normal));
    }
    return edges;
}
