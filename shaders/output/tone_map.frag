// Maps radiance to display colours, or copies it; see Display in tone_map.hpp. One fragment per pixel of the target.
// AUTOMATIC: times the exposure that exposure.comp has found for the picture.
#include "bindings.glsl"
#include "maths.glsl"
#include "output/tone_curves.glsl"

layout(binding = UNIT_RADIANCE) uniform sampler2D radiance;
#ifdef AUTOMATIC
layout(std430, binding = BINDING_EXPOSURE) readonly restrict buffer Exposure { vec2 exposures[]; };
#endif

uniform float exposure;
uniform uint curve;          // TONE_CURVE_*
uniform bool encoded;
uniform bool opaque;
uniform float colour_step;   // between two colours that the target tells apart
uniform vec2 target_origin;  // in the framebuffer, pixels
uniform vec2 target_size;

layout(location = 0) out vec4 colour;

// Radiance of a picture of another size than the target, interpolated bilinearly.
vec4 scaled_radiance(vec2 pixel, vec2 size) {
    vec2 at = pixel / target_size * size - 0.5;
    ivec2 first = ivec2(floor(at));
    ivec2 last = ivec2(size) - 1;
    vec2 share = at - vec2(first);
    vec4 low = mix(texelFetch(radiance, clamp(first, ivec2(0), last), 0),
                   texelFetch(radiance, clamp(first + ivec2(1, 0), ivec2(0), last), 0), share.x);
    vec4 high = mix(texelFetch(radiance, clamp(first + ivec2(0, 1), ivec2(0), last), 0),
                    texelFetch(radiance, clamp(first + ivec2(1), ivec2(0), last), 0), share.x);
    return mix(low, high, share.y);
}

// Noise in (-0.5, 0.5), whose mean over neighbours is nearly 0: Jimenez, "Next Generation Post Processing in Call of Duty:
// Advanced Warfare" (2014), "interleaved gradient noise". 0.99: values that the target has stay as they are.
float dither(vec2 pixel) { return 0.99 * (fract(52.9829189 * fract(dot(pixel, vec2(0.06711056, 0.00583715)))) - 0.5); }

void main() {
    vec2 size = vec2(textureSize(radiance, 0));
    vec2 pixel = gl_FragCoord.xy - target_origin;
    vec4 linear = size == target_size ? texelFetch(radiance, ivec2(pixel), 0) : scaled_radiance(pixel, size);
    vec3 shown = linear.rgb * exposure;
#ifdef AUTOMATIC
    shown *= exposures[0].x;
#endif
    shown = tone_curve(curve, shown);
    // Rounded as they are, slow gradients would have bands.
    if (encoded) shown = srgb_encode(shown) + colour_step * dither(pixel);
    colour = vec4(shown, opaque ? 1.0 : linear.a);
}
