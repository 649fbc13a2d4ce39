// Light lists of screen tiles, bound by the surfaces in them where there is a depth texture.
#include "light_cull.glsl"

layout(binding = UNIT_DEPTH) uniform sampler2D depth_texture;

uniform bool has_depth;
uniform vec2 depth_terms;  // a and b of window depth = a·z + b (orthographic), -a + b / depth (perspective)

float view_depth(float window_depth) {
    if (orthographic) return (depth_terms.y - window_depth) / depth_terms.x;
    return depth_terms.y / (window_depth + depth_terms.x);
}

// Depths of the tile's surfaces, a little widened; nothing: nearest > farthest.
Cell bound_by_depth(uvec2 tile) {
    uvec2 first = tile * tile_size;
    uvec2 end = min(first + tile_size, target_pixels);
    Cell cell = make_cell(tile, 1.0 / 0.0, 0.0, 0u);
    for (uint y = first.y; y < end.y; ++y) {
        for (uint x = first.x; x < end.x; ++x) {
            float window_depth = texelFetch(depth_texture, ivec2(x, y), 0).r;
            if (window_depth == 0.0) continue;
            float depth = view_depth(window_depth);
            cell.nearest = min(cell.nearest, depth);
            cell.farthest = max(cell.farthest, depth);
        }
    }
    if (cell.nearest > cell.farthest) return cell;
    float slack = 1e-4 * (abs(cell.nearest) + abs(cell.farthest));
    cell.nearest -= slack;
    cell.farthest += slack;
    for (uint y = first.y; y < end.y; ++y) {
        for (uint x = first.x; x < end.x; ++x) {
            float window_depth = texelFetch(depth_texture, ivec2(x, y), 0).r;
            if (window_depth == 0.0) continue;
            float depth = view_depth(window_depth);
            cell.mask |= slices_between(cell, depth - 0.1 * slack, depth + 0.1 * slack);
        }
    }
    return cell;
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= grid_tiles.x * grid_tiles.y) return;
    uvec2 tile = uvec2(index % grid_tiles.x, index / grid_tiles.x);
    float nearest = orthographic ? -1.0e30 : 0.0;
    cull(index, has_depth ? bound_by_depth(tile) : make_cell(tile, nearest, 1.0e30, 0xffffffffu));
}
