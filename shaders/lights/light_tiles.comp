// Culls the light lists of screen tiles, with `has_depth` against the depths of the tile's surfaces.
#include "lights/light_cull.glsl"

layout(std430, binding = BINDING_TILE_DEPTHS) readonly restrict buffer TileDepths { TileDepth tile_depths[]; };

uniform bool has_depth;

void main() {
    uint index = cell_here();
    if (index >= grid.tiles.x * grid.tiles.y) return;
    uvec2 tile = uvec2(index % grid.tiles.x, index / grid.tiles.x);
    TileDepth bounds = TileDepth(view.orthographic != 0u ? -1.0e30 : 0.0, 1.0e30, 0xffffffffu, 0u);
    if (has_depth) bounds = tile_depths[index];
    cull(index, make_cell(tile, bounds.nearest, bounds.farthest, bounds.mask));
}
