// Light lists of clusters: screen tiles cut into slices of depth.
#include "light_cull.glsl"

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= grid_tiles.x * grid_tiles.y * grid_slices) return;
    uint row = index / grid_tiles.x;
    uvec2 tile = uvec2(index % grid_tiles.x, row % grid_tiles.y);
    uint slice = row / grid_tiles.y;
    // A thousandth of slack: whoever looks a depth up rounds the logarithm in its own way.
    float nearest = slice == 0u ? (orthographic ? -1.0e30 : 0.0) : first_depth * pow(depth_ratio, float(slice) - 1.0) * 0.999;
    float farthest = slice + 1u == grid_slices ? 1.0e30 : first_depth * pow(depth_ratio, float(slice)) * 1.001;
    cull(index, make_cell(tile, nearest, farthest, 0xffffffffu));
}
