// Interleaved gathering: each pixel sums the light of its class's share of the VPLs (vpl_shares.glsl). A work group
// handles a block of pixels of one class, `interleave` pixels apart, so that all its invocations loop over the same
// VPLs; its z index is the class.
#include "bindings.glsl"
#include "loop_part.glsl"
#include "shading/pixel_block.glsl"
#include "surfaces/visible_surface.glsl"
#define VPL_ORDER
#include "indirect/vpl_light.glsl"
#include "indirect/vpl_shares.glsl"

layout(rgba32f, binding = IMAGE_INDIRECT) restrict uniform image2D gathered_irradiance;
#ifdef DIRECTED
layout(rgba32f, binding = IMAGE_INDIRECT_DIRECTION) restrict uniform image2D gathered_flow;
#endif

void main() {
    uvec2 offset = uvec2(gl_WorkGroupID.z % interleave, gl_WorkGroupID.z / interleave);
    float depth[SURFACES];
    Surface surfaces[SURFACES];
    Gathered gathered[SURFACES];
    float nearest = 0.0;
    for (int s = 0; s < SURFACES; ++s) {
        ivec2 at = min(int(interleave) * block_pixel(s) + ivec2(offset), ivec2(view.target_size) - 1);
        depth[s] = texelFetch(surface_depth, at, 0).r;
        nearest = max(nearest, depth[s]);
        surfaces[s] = visible_surface(at, depth[s], vec3(0.0));
        gathered[s] = nothing_gathered();
    }
    uint classes = interleave * interleave;
    uint share = share_of_class(offset);
    uint first = share * vpl_constants.count / classes + part_first;
    uint last = min((share + 1u) * vpl_constants.count / classes, first + part_size);
    if (nearest > 0.0) add_vpls(vpl_list(first, 1u, last), surfaces, gathered);
    // Multiplied by the number of classes: the estimate for all VPLs. OpenGL discards stores outside the image.
    for (int s = 0; s < SURFACES; ++s) {
        ivec2 at = int(interleave) * block_pixel(s) + ivec2(offset);
        vec4 sum = depth[s] > 0.0 ? vec4(float(classes) * gathered[s].irradiance, 1.0) : vec4(0.0);
        if (part_first > 0u) sum.rgb += imageLoad(gathered_irradiance, at).rgb;
        imageStore(gathered_irradiance, at, sum);
#ifdef DIRECTED
        vec4 flow = depth[s] > 0.0 ? float(classes) * gathered[s].flow : vec4(0.0);
        if (part_first > 0u) flow += imageLoad(gathered_flow, at);
        imageStore(gathered_flow, at, flow);
#endif
    }
}
