// The grid of cells (screen tiles, or clusters of tiles and depth slices) that the view is divided into. Each cell has
// a light list.
#include "bindings.glsl"
#include "types.glsl"

layout(std140, binding = UNIFORMS_CELLS) uniform Cells { CellConstants grid; };

// Divides [nearest, farthest] into 32 slices and returns a bit for each slice that [a, b] touches; all bits if the
// range is empty.
uint slices_between(float nearest, float farthest, float a, float b) {
    float extent = farthest - nearest;
    if (extent <= 0.0) return 0xffffffffu;
    vec2 at = clamp((vec2(a, b) - nearest) / extent * 32.0, 0.0, 31.0);
    uint low = uint(at.x);
    uint count = uint(at.y) - low + 1u;
    return count >= 32u ? 0xffffffffu : ((1u << count) - 1u) << low;
}

// Index of the cluster slice that contains a view depth in metres.
uint slice_of(float depth) {
    if (depth <= grid.first_depth) return 0u;
    float slice = 1.0 + floor(log(depth / grid.first_depth) / log(grid.depth_ratio));
    return uint(min(slice, float(grid.slices - 1u)));
}

uint cell_index(uvec2 tile, uint slice) { return (slice * grid.tiles.y + tile.y) * grid.tiles.x + tile.x; }
