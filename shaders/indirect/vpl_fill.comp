// Gathers VPLs for the listed pixels, for which reconstruction found too few classes. Such a pixel sums one in one_in
// VPLs; neighbouring pixels sum different ones. The result is the mean of both estimates, weighted by the number of
// VPLs behind each: README.md, "Pixels without enough neighbours". One invocation per listed pixel.
#include "bindings.glsl"
#include "loop_part.glsl"
#include "surfaces/visible_surface.glsl"
// Surfels in the order of the buffer: neighbours have adjacent indices and so are summed by different pixels.
#ifndef SURFELS
#define VPL_ORDER
#endif
#include "indirect/vpl_light.glsl"

layout(local_size_x = FILL_GROUP) in;

layout(std430, binding = BINDING_FILL_LIST) readonly restrict buffer FillList {
    uint fill_groups[3];
    uint fill_count;
    uint fill_pixels[];
};

uniform uint one_in;  // 2 or 4

layout(rgba32f, binding = IMAGE_INDIRECT) restrict uniform image2D reconstructed;
#ifdef DIRECTED
layout(rgba32f, binding = IMAGE_INDIRECT_DIRECTION) restrict uniform image2D reconstructed_flow;
#endif

void main() {
    if (gl_GlobalInvocationID.x >= fill_count) return;
    uint packed_pixel = fill_pixels[gl_GlobalInvocationID.x];
    ivec2 at = ivec2(packed_pixel & 0xffffu, packed_pixel >> 16);
    Surface surfaces[SURFACES];
    Gathered gathered[SURFACES];
    surfaces[0] = visible_surface(at, texelFetch(surface_depth, at, 0).r, vec3(0.0));
    gathered[0] = nothing_gathered();
    // The four pixels of 2 × 2 sum different quarters, or halves as on a chessboard: no stripes are seen.
    uint offset = uint(2 * ((at.x ^ at.y) & 1) + (at.y & 1)) * one_in / 4u;
    uint end = min(vpl_constants.count, one_in * (part_first + part_size));
    add_vpls(vpl_list(one_in * part_first + offset, one_in, end), surfaces, gathered);
    vec4 found = imageLoad(reconstructed, at);
    float weight = 1.0 / (found.a + 1.0 / float(one_in));  // the sum over a half is half of the estimate
    float kept = part_first == 0u ? found.a * weight : 1.0;
    imageStore(reconstructed, at, vec4(kept * found.rgb + weight * gathered[0].irradiance, found.a));
#ifdef DIRECTED
    imageStore(reconstructed_flow, at, kept * imageLoad(reconstructed_flow, at) + weight * gathered[0].flow);
#endif
}
