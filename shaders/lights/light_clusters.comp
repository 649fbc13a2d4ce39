// Culls the light lists of clusters: screen tiles divided into depth slices.
#include "lights/light_cull.glsl"

void main() {
    uint index = cell_here();
    if (index >= grid.tiles.x * grid.tiles.y * grid.slices) return;
    uint row = index / grid.tiles.x;
    uvec2 tile = uvec2(index % grid.tiles.x, row % grid.tiles.y);
    uint slice = row / grid.tiles.y;
    // A margin of 0.1 %, since slice_of rounds the logarithm differently from pow here.
    float nearest = slice == 0u ? (view.orthographic != 0u ? -1.0e30 : 0.0) : grid.first_depth * pow(grid.depth_ratio, float(slice) - 1.0) * 0.999;
    float farthest = slice + 1u == grid.slices ? 1.0e30 : grid.first_depth * pow(grid.depth_ratio, float(slice)) * 1.001;
    cull(index, make_cell(tile, nearest, farthest, 0xffffffffu));
}
