// The atlas of the VPLs' depth maps: square slots (VplTile) in the layers of an array texture. A slot holds what is seen
// from a VPL (MapFrame): the hemisphere above its surface in the hemi-octahedral map, or, if the VPL is far from the
// focus, a perspective picture of the focus, in which a texel is much smaller there. Depth is the inverse of the
// octahedral distance |x| + |y| + z or of z, so that it is linear over a plane (theory.md, "One plane in a VPL map"): 1 at
// VplConstants::map_near and nearer, 0 where there is no surface.
#include "maths.glsl"
#include "types.glsl"
#include "vpls/vpl_constants.glsl"

struct VplTile {
    uvec2 corner;  // first texel of the slot
    uint layer;
};

VplTile vpl_tile(uint map) {
    uint tiles = vpl_constants.map_tiles;
    uint of_layer = map % (tiles * tiles);
    uvec2 place = uvec2(of_layer % tiles, of_layer / tiles);
    return VplTile(place * vpl_constants.map_resolution, map / (tiles * tiles));
}

// Where the depth map of a VPL at that position is seen from.
vec3 vpl_map_origin(vec3 position, vec3 normal) { return position + vpl_constants.ray_offset * normal; }

// The space of a map, with its origin at vpl_map_origin.
struct MapFrame {
    mat3 map_from_world;
    float tangent;  // of half the field of view of a perspective map, which looks along +z; 0: hemi-octahedral around +z
};

MapFrame vpl_map_frame(vec3 position, vec3 normal) {
    vec3 to_focus = vpl_constants.focus_centre - position;
    float radius2 = vpl_constants.focus_radius * vpl_constants.focus_radius;
    float distance2 = dot(to_focus, to_focus);
    bool is_far = radius2 > 0.0 && distance2 > 4.0 * radius2;
    vec3 axis = is_far ? to_focus * inversesqrt(distance2) : normal;
    vec3 tangent, bitangent;
    basis_around(axis, tangent, bitangent);
    // The cone around the sphere: sin = radius / distance.
    return MapFrame(transpose(mat3(tangent, bitangent, axis)), is_far ? sqrt(radius2 / (distance2 - radius2)) : 0.0);
}

bool is_perspective(MapFrame frame) { return frame.tangent > 0.0; }

// Where depth 1 is in the direction of a place in the map, in [-1, 1]², in units of map_near.
vec3 vpl_map_point(MapFrame frame, vec2 place) {
    return is_perspective(frame) ? vec3(frame.tangent * place, 1.0) : hemi_octahedral_point(place);
}

// Place in the map of a direction in its space.
vec2 vpl_map_place(MapFrame frame, vec3 at) {
    return is_perspective(frame) ? at.xy / (at.z * frame.tangent) : hemi_octahedral_encode(at);
}

// `at`: in the map's space, metres from its origin.
float vpl_map_depth(MapFrame frame, vec3 at) {
    float distance = is_perspective(frame) ? at.z : abs(at.x) + abs(at.y) + at.z;
    return min(vpl_constants.map_near / distance, 1.0);
}
