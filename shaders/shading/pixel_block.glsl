// The pixels of a work group and its invocations, for compute shaders that shade. A work group shades a block of
// 16 × 16 pixels. On the CPU, an invocation shades four of them, 8 apart, so that it fetches each light once for four
// pixels. With shadow rays to VPLs, whose cost exceeds that of any fetch, it shades one (ONE_SURFACE), and on GPUs, where
// it needs half as many registers then.
#include "bindings.glsl"

#if defined(VPL_VISIBILITY_RAYS) || defined(ONE_SURFACE)
#define SURFACES 1
#define GROUP_SIDE PIXEL_BLOCK
#else
#define SURFACES 4
#define GROUP_SIDE (PIXEL_BLOCK / 2)
#endif

layout(local_size_x = GROUP_SIDE, local_size_y = GROUP_SIDE) in;

uniform uint first_row;  // of blocks, in this dispatch: see ComputeSteps::run_rows

// The invocation's pixel s; may lie outside the target.
ivec2 block_pixel(int s) {
    ivec2 block = ivec2(gl_WorkGroupID.x, first_row + gl_WorkGroupID.y);
    return PIXEL_BLOCK * block + ivec2(gl_LocalInvocationID.xy) + GROUP_SIDE * ivec2(s & 1, s >> 1);
}
