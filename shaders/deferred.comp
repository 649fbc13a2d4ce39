// Shades the G-buffer, a tile of 16 × 16 pixels a work group. An invocation takes four of them, 8 apart, and fetches each
// light once for all four; with rays, which cost more than any fetch, it takes one, as software drivers end the loops of
// an invocation after 65,536 turns in all.
#include "bindings.glsl"

#ifdef VPL_VISIBILITY_RAYS
#define SURFACES 1
#define GROUP_SIDE 16
#else
#define SURFACES 4
#define GROUP_SIDE 8
#endif
#include "lighting.glsl"

layout(local_size_x = GROUP_SIDE, local_size_y = GROUP_SIDE) in;

uniform mat4 world_from_clip;
uniform vec2 target_size;

layout(binding = UNIT_ALBEDO) uniform sampler2D gbuffer_albedo;
layout(binding = UNIT_NORMAL) uniform sampler2D gbuffer_normal;
layout(binding = UNIT_DEPTH) uniform sampler2D gbuffer_depth;
layout(rgba32f, binding = IMAGE_RADIANCE) writeonly restrict uniform image2D radiance;

ivec2 pixel(int s) {
    ivec2 tile = 16 * ivec2(gl_WorkGroupID.xy);
    return tile + ivec2(gl_LocalInvocationID.xy) + GROUP_SIDE * ivec2(s & 1, s >> 1);
}

void main() {
    float depth[SURFACES];
    Surface surfaces[SURFACES];
    uvec2 pixels[SURFACES];
    float nearest = 0.0;
    for (int s = 0; s < SURFACES; ++s) {
        ivec2 at = min(pixel(s), ivec2(target_size) - 1);
        pixels[s] = uvec2(at);
        depth[s] = texelFetch(gbuffer_depth, at, 0).r;
        nearest = max(nearest, depth[s]);
        PackedSurface stored = PackedSurface(texelFetch(gbuffer_albedo, at, 0).rgb, texelFetch(gbuffer_normal, at, 0).rg);
        surfaces[s] = unpack_surface(stored, vec3(vec2(at) + 0.5, depth[s]), target_size, world_from_clip);
    }
    vec3 reflected[SURFACES];
    for (int s = 0; s < SURFACES; ++s) reflected[s] = vec3(0.0);
    if (nearest > 0.0) reflect_radiance(surfaces, pixels, reflected);
    // Stores beyond the target are discarded by the GL.
    for (int s = 0; s < SURFACES; ++s) imageStore(radiance, pixel(s), depth[s] > 0.0 ? vec4(reflected[s], 1.0) : vec4(0.0));
}
