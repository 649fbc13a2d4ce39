// The exposure by which the log-average luminance of a picture becomes 18 % grey: Reinhard et al., "Photographic Tone
// Reproduction for Digital Images" (2002), eq. 1 and 2. EXPOSURE_GROUPS work groups, each for its share of the pixels,
// then, with `finish`, one for the results of all groups.
#include "bindings.glsl"

layout(local_size_x = EXPOSURE_GROUP) in;

layout(binding = UNIT_RADIANCE) uniform sampler2D radiance;

// The exposure and the log-average luminance; then, of each group, the sums of weight · log2(luminance) and of weights.
layout(std430, binding = BINDING_EXPOSURE) restrict buffer Exposure { vec2 exposures[]; };

uniform bool finish;

const float GREY = 0.18;
const float LOWEST = exp2(-10.0);
const float HIGHEST = exp2(10.0);
// The luminance of a pixel that counts half. Darker ones count ever less: the logarithm of what is nearly black is so low
// that a few such pixels would decide the exposure. It is about a tenth of the luminance that HIGHEST makes 18 % grey.
const float FAINT = exp2(-16.0);

shared vec2 parts[EXPOSURE_GROUP];

// Whether it is positive and finite, and not so small that drivers may take it for 0. By the bits, because compilers may
// assume that all values are finite.
bool counts(float luminance) { return floatBitsToUint(luminance) - 0x00800000u < 0x7f000000u; }

vec2 of_pixel(uint i, uint width) {
    vec3 light = texelFetch(radiance, ivec2(i % width, i / width), 0).rgb;
    float luminance = dot(light, vec3(0.2126, 0.7152, 0.0722));
    if (!counts(luminance)) return vec2(0.0);
    float weight = 1.0 / (1.0 + FAINT / luminance);
    return weight * vec2(log2(luminance), 1.0);
}

vec2 of_picture() {
    uvec2 size = uvec2(textureSize(radiance, 0));
    vec2 sums = vec2(0.0);
    for (uint i = gl_GlobalInvocationID.x; i < size.x * size.y; i += EXPOSURE_GROUPS * EXPOSURE_GROUP) {
        sums += of_pixel(i, size.x);
    }
    return sums;
}

vec2 of_groups() {
    vec2 sums = vec2(0.0);
    for (uint i = gl_LocalInvocationID.x; i < EXPOSURE_GROUPS; i += EXPOSURE_GROUP) sums += exposures[1u + i];
    return sums;
}

// 1 if no pixel counts.
vec2 exposure_of(vec2 sums) {
    if (sums.y == 0.0) return vec2(1.0, 0.0);
    float average = exp2(sums.x / sums.y);
    return vec2(clamp(GREY / average, LOWEST, HIGHEST), average);
}

void main() {
    uint own = gl_LocalInvocationID.x;
    parts[own] = finish ? of_groups() : of_picture();
    for (uint others = EXPOSURE_GROUP / 2; others > 0u; others /= 2u) {
        memoryBarrierShared();
        barrier();
        if (own < others) parts[own] += parts[own + others];
    }
    if (own > 0u) return;
    if (finish) {
        exposures[0] = exposure_of(parts[0]);
    } else {
        exposures[1u + gl_WorkGroupID.x] = parts[0];
    }
}
