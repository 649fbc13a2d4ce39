// Light of a patch of the sky (renderer/passes/sky/sky_patches.hpp): a Vpl whose position is the unit direction towards
// it, and whose radius2 is the square of its half width in radians.
#include "types.glsl"

// What a surface receives of a patch.
struct PatchLight {
    vec3 direction;  // towards the part of the patch that is above the surface's horizon; not normalised
    float cosine;    // mean over the patch of the cosine to the surface's normal, 0 below the horizon
};

// The cosine is taken to be evenly distributed over [c - h, c + h], c being that of the patch's middle and h its half
// width. See theory.md, "Light of the sky".
PatchLight light_of_patch(Vpl sky_patch, vec3 normal) {
    float middle = dot(sky_patch.position, normal);
    float half_width = sqrt(sky_patch.radius2);
    float above = middle + half_width;
    if (above <= 0.0) return PatchLight(sky_patch.position, 0.0);
    if (middle >= half_width) return PatchLight(sky_patch.position, middle);
    return PatchLight(sky_patch.position + (2.0 / 3.0 * above - middle) * normal, above * above / (4.0 * half_width));
}
