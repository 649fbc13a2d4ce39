// The atlas of the VPLs' depth maps: square tiles in the layers of an array. A tile holds the hemisphere that a VPL looks
// into, hemi-octahedrally. Depth is reversed as everywhere: 1 at the VPL, 0 at least a scene's diameter away and where
// nothing is.
#include "maths.glsl"
#include "types.glsl"

uniform uint vpl_map_resolution;    // texels along a side of a tile
uniform uint vpl_tiles;             // along a side of a layer
uniform float vpl_map_inverse_reach;  // 1/m: where depth is 0
uniform float vpl_ray_offset;       // metres, off the VPL's surface: where its map, and its rays, start

struct VplTile {
    uvec2 corner;  // its first texel
    uint layer;
};

VplTile vpl_tile(uint map) {
    uint of_layer = map % (vpl_tiles * vpl_tiles);
    uvec2 place = uvec2(of_layer % vpl_tiles, of_layer / vpl_tiles);
    return VplTile(place * vpl_map_resolution, map / (vpl_tiles * vpl_tiles));
}

vec3 vpl_map_origin(Vpl vpl) { return vpl.position + vpl_ray_offset * vpl.normal; }

float vpl_map_depth(float distance) { return 1.0 - distance * vpl_map_inverse_reach; }
