// Shades the G-buffer. One work group per block of PIXEL_BLOCK² pixels, one invocation SURFACES of them.
#include "bindings.glsl"

#include "shading/pixel_block.glsl"
#include "shading/lighting.glsl"
#include "surfaces/visible_surface.glsl"

layout(binding = UNIT_ALBEDO) uniform sampler2D gbuffer_albedo;
#ifdef GLOSSY
layout(binding = UNIT_MIRROR) uniform sampler2D gbuffer_mirror;
layout(binding = UNIT_GLOSS) uniform sampler2D gbuffer_gloss;
#endif
#ifdef BUMPY
layout(binding = UNIT_BUMPS) uniform sampler2D gbuffer_bumps;
#endif
layout(rgba32f, binding = IMAGE_RADIANCE) restrict uniform image2D radiance;

void main() {
    float depth[SURFACES];
    Surface surfaces[SURFACES];
    uvec2 pixels[SURFACES];
    float nearest = 0.0;
    for (int s = 0; s < SURFACES; ++s) {
        ivec2 at = min(block_pixel(s), ivec2(view.target_size) - 1);
        pixels[s] = uvec2(at);
        depth[s] = texelFetch(surface_depth, at, 0).r;
        nearest = max(nearest, depth[s]);
        surfaces[s] = visible_surface(at, depth[s], texelFetch(gbuffer_albedo, at, 0).rgb);
#ifdef GLOSSY
        set_gloss(surfaces[s], PackedGloss(texelFetch(gbuffer_mirror, at, 0), texelFetch(gbuffer_gloss, at, 0).rg));
#endif
#ifdef BUMPY
        vec4 bumps = texelFetch(gbuffer_bumps, at, 0);
        set_bumps(surfaces[s], PackedBumps(bumps.xy, bumps.z));
#endif
    }
    vec3 reflected[SURFACES];
    for (int s = 0; s < SURFACES; ++s) reflected[s] = vec3(0.0);
    if (nearest > 0.0) reflect_radiance(surfaces, pixels, reflected);
    // OpenGL discards stores outside the image.
    for (int s = 0; s < SURFACES; ++s) {
        vec4 sum = depth[s] > 0.0 ? vec4(reflected[s], 1.0) : vec4(0.0);
        if (part_first > 0u) sum.rgb += imageLoad(radiance, block_pixel(s)).rgb;
        imageStore(radiance, block_pixel(s), sum);
    }
}
