// The atlas of the VPLs' depth maps: square slots (VplTile) in the layers of an array texture. A slot holds the
// hemisphere above a VPL's surface in the hemi-octahedral map. Depth is linear in distance and reversed: 1 at the VPL,
// 0 at a distance of at least the scene's diameter and where there is no surface.
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

vec3 vpl_map_origin(Vpl vpl) { return vpl.map_origin + vpl_constants.ray_offset * vpl.normal; }

float vpl_map_depth(float distance) { return 1.0 - distance * vpl_constants.map_inverse_reach; }
