// The atlas of the VPLs' depth maps: square slots (VplTile) in the layers of an array texture. A slot holds the
// hemisphere above a VPL's surface in the hemi-octahedral map. Depth is the inverse of the octahedral distance
// |x| + |y| + z, so that it is linear over a plane (theory.md, "One plane in a VPL map"): 1 at VplConstants::map_near and
// nearer, 0 where there is no surface.
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

// `at`: in the map's space, metres from its origin.
float vpl_map_depth(vec3 at) { return min(vpl_constants.map_near / (abs(at.x) + abs(at.y) + at.z), 1.0); }
