// The atlas of the VPLs' maps: square slots (VplTile) in the layers of an array texture. A slot holds what is seen
// from a VPL (MapFrame): the hemisphere above its surface in the hemi-octahedral map, or, if the VPL is far from the
// focus (SURFEL_MAP_FOCI), a perspective picture of the focus, in which a texel is much smaller there. `map` is
// Surfel::map, or the index of a traced VPL. Depth is the inverse of the
// octahedral distance |x| + |y| + z or of z, so that it is linear over a plane (README.md, "Planes in VPL maps"): 1 at
// VplConstants::map_near and nearer, 0 where there is no surface. With its slope a texel knows the plane that it sees.
#include "maths.glsl"
#include "types.glsl"
#include "vpls/vpl_constants.glsl"

struct VplTile {
    uvec2 corner;  // first texel of the slot
    uint layer;
};

VplTile vpl_tile(uint map) {
    uint tiles = vpl_constants.map_tiles;
    uint slot = map & SURFEL_MAP_SLOT;
    uint of_layer = slot % (tiles * tiles);
    uvec2 place = uvec2(of_layer % tiles, of_layer / tiles);
    return VplTile(place * vpl_constants.map_resolution, slot / (tiles * tiles));
}

// Where the depth map of a VPL at that position is seen from.
vec3 vpl_map_origin(vec3 position, vec3 normal) { return position + vpl_constants.ray_offset * normal; }

// How a map sees the world. A direction in its space meets the surface bend (|x| + |y|) + z = 1 in the point that the map
// stores: the octahedron, or the plane z = 1 (README.md, "Planes in VPL maps").
struct MapFrame {
    mat3 map_from_world;
    float bend;   // 1: hemi-octahedral, around +z (Cigolle et al. 2014); 0: perspective, along +z
    float width;  // half a diagonal of the square that the map covers on that surface
};

MapFrame vpl_map_frame(vec3 position, vec3 normal, uint map) {
    bool is_far = map > SURFEL_MAP_SLOT;
    vec4 focus = vpl_constants.foci[is_far ? (map >> SURFEL_MAP_FOCUS_SHIFT) - 1u : 0u];
    vec3 to_focus = focus.xyz - position;
    float radius2 = focus.w * focus.w;
    float distance2 = dot(to_focus, to_focus);
    vec3 axis = is_far ? to_focus * inversesqrt(distance2) : normal;
    vec3 tangent, bitangent;
    basis_around(axis, tangent, bitangent);
    // The square is around the circle in which the plane cuts the cone around the sphere: sin = radius / distance.
    float width = is_far ? sqrt(2.0 * radius2 / (distance2 - radius2)) : 1.0;
    return MapFrame(transpose(mat3(tangent, bitangent, axis)), is_far ? 0.0 : 1.0, width);
}

// Length of a vector along the surface's shape: 1 on it.
float vpl_map_length(MapFrame frame, vec3 at) { return frame.bend * (abs(at.x) + abs(at.y)) + at.z; }

// Place in the map, in [-1, 1]², of a point of its surface. Its sides are diagonal to x and y.
vec2 vpl_map_place(MapFrame frame, vec3 point) {
    vec2 p = point.xy * (1.0 / frame.width);
    return vec2(p.x + p.y, p.x - p.y);
}

// The point of the surface at a place in the map.
vec3 vpl_map_point(MapFrame frame, vec2 place) {
    vec2 p = frame.width * 0.5 * vec2(place.x + place.y, place.x - place.y);
    return vec3(p, 1.0 - frame.bend * abs(p.x) - frame.bend * abs(p.y));
}

// `at`: in the map's space, metres from its origin.
float vpl_map_depth(MapFrame frame, vec3 at) { return min(vpl_constants.map_near / vpl_map_length(frame, at), 1.0); }

// On which side of the folds x = 0 and y = 0 of the octahedron a texel is: signs of x and y.
vec2 vpl_map_side(uvec2 texel) {
    return vec2(texel.x + texel.y + 1u >= vpl_constants.map_resolution ? 1.0 : -1.0, texel.x >= texel.y ? 1.0 : -1.0);
}

// Change of a plane's depth along x and y at a point of the surface, relative to the depth there. `normal`: of any length.
vec2 slope_of_plane(MapFrame frame, vec3 point, vec3 normal, vec2 side) {
    return (normal.xy - frame.bend * side * normal.z) / dot(normal, point);
}

// The upper halves of both floats, rounded: a 512th of their values, and read in one step.
uint pack_slope(vec2 slope) {
    uvec2 bits = floatBitsToUint(clamp(slope, -1e6, 1e6)) + 0x8000u;
    return bits.x >> 16u | (bits.y & 0xffff0000u);
}
