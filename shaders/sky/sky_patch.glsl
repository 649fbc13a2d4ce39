// Light of a patch of the sky (renderer/passes/sky/sky_patches.hpp).
#include "bindings.glsl"
#include "types.glsl"

#ifdef SKY
layout(std140, binding = UNIFORMS_SKY) uniform SkyPatches { SkyPatch sky_patches[MOST_SKY_PATCHES]; };
#endif

// What a surface receives of a patch.
struct PatchLight {
    vec3 direction;  // towards the part of the patch that is above the surface's horizon; not normalised
    float cosine;    // mean over the patch of the cosine to the surface's normal, 0 below the horizon
};

// The cosine is taken to be evenly distributed over [c - h, c + h], c being that of the patch's middle and h its half
// width. See README.md, "Light of the sky".
PatchLight light_of_patch(SkyPatch sky_patch, vec3 normal) {
    float middle = dot(sky_patch.direction, normal);
    float half_width = sqrt(sky_patch.half_width2);
    float above = middle + half_width;
    if (above <= 0.0) return PatchLight(sky_patch.direction, 0.0);
    if (middle >= half_width) return PatchLight(sky_patch.direction, middle);
    return PatchLight(sky_patch.direction + (2.0 / 3.0 * above - middle) * normal, above * above / (4.0 * half_width));
}
