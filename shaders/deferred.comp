// Shades the G-buffer, a block of pixels a work group.
#include "bindings.glsl"

#include "pixel_block.glsl"
#include "lighting.glsl"

uniform mat4 world_from_clip;
uniform vec2 target_size;

layout(binding = UNIT_ALBEDO) uniform sampler2D gbuffer_albedo;
layout(binding = UNIT_NORMAL) uniform sampler2D gbuffer_normal;
layout(binding = UNIT_DEPTH) uniform sampler2D gbuffer_depth;
layout(rgba32f, binding = IMAGE_RADIANCE) writeonly restrict uniform image2D radiance;

void main() {
    float depth[SURFACES];
    Surface surfaces[SURFACES];
    uvec2 pixels[SURFACES];
    float nearest = 0.0;
    for (int s = 0; s < SURFACES; ++s) {
        ivec2 at = min(block_pixel(s), ivec2(target_size) - 1);
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
    for (int s = 0; s < SURFACES; ++s) imageStore(radiance, block_pixel(s), depth[s] > 0.0 ? vec4(reflected[s], 1.0) : vec4(0.0));
}
