// Finds the nearest and farthest surface in each screen tile, and which of 32 depth slices between them have surfaces.
// One work group per tile.
#include "bindings.glsl"
#include "lights/light_cells.glsl"
#include "maths.glsl"
#include "types.glsl"
#include "view/view.glsl"

layout(local_size_x = 64) in;

layout(std430, binding = BINDING_TILE_DEPTHS) writeonly restrict buffer TileDepths { TileDepth tile_depths[]; };

layout(binding = UNIT_DEPTH) uniform sampler2D depth_texture;

// Depths as integers in the same order, for atomicMin and atomicMax.
shared uint nearest_bits;
shared uint farthest_bits;
shared uint mask;

uint ordered_bits(float depth) {
    uint bits = floatBitsToUint(depth);
    return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}

float from_ordered_bits(uint bits) {
    return uintBitsToFloat((bits & 0x80000000u) != 0u ? bits & 0x7fffffffu : ~bits);
}

float view_depth(float window_depth) {
    if (view.orthographic != 0u) return (view.depth_terms.y - window_depth) / view.depth_terms.x;
    return view.depth_terms.y / (window_depth + view.depth_terms.x);
}

void main() {
    if (gl_LocalInvocationIndex == 0u) {
        nearest_bits = ordered_bits(INFINITY);
        farthest_bits = ordered_bits(-INFINITY);
        mask = 0u;
    }
    memoryBarrierShared();
    barrier();
    uvec2 tile = gl_WorkGroupID.xy;
    uvec2 first = tile * grid.tile_size;
    uvec2 extent = min(first + grid.tile_size, grid.target_size) - first;
    uint pixels = extent.x * extent.y;
    float nearest = INFINITY;
    float farthest = -INFINITY;
    for (uint i = gl_LocalInvocationIndex; i < pixels; i += 64u) {
        float window_depth = texelFetch(depth_texture, ivec2(first + uvec2(i % extent.x, i / extent.x)), 0).r;
        if (window_depth == 0.0) continue;
        float depth = view_depth(window_depth);
        nearest = min(nearest, depth);
        farthest = max(farthest, depth);
    }
    atomicMin(nearest_bits, ordered_bits(nearest));
    atomicMax(farthest_bits, ordered_bits(farthest));
    memoryBarrierShared();
    barrier();
    // The bounds get a margin of 1e-4 for rounding. A tile without surfaces has nearest > farthest.
    TileDepth bounds = TileDepth(from_ordered_bits(nearest_bits), from_ordered_bits(farthest_bits), 0u, 0u);
    bool has_surface = bounds.nearest <= bounds.farthest;
    float slack = has_surface ? 1e-4 * (abs(bounds.nearest) + abs(bounds.farthest)) : 0.0;
    bounds.nearest -= slack;
    bounds.farthest += slack;
    uint seen = 0u;
    for (uint i = gl_LocalInvocationIndex; i < pixels; i += 64u) {
        float window_depth = texelFetch(depth_texture, ivec2(first + uvec2(i % extent.x, i / extent.x)), 0).r;
        if (window_depth == 0.0) continue;
        float depth = view_depth(window_depth);
        seen |= slices_between(bounds.nearest, bounds.farthest, depth - 0.1 * slack, depth + 0.1 * slack);
    }
    atomicOr(mask, seen);
    memoryBarrierShared();
    barrier();
    if (gl_LocalInvocationIndex > 0u) return;
    bounds.mask = mask;
    tile_depths[tile.y * grid.tiles.x + tile.x] = bounds;
}
