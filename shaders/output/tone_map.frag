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

void main() {
    vec2 size = vec2(textureSize(radiance, 0));
    vec2 pixel = gl_FragCoord.xy - target_origin;
    vec4 linear = size == target_size ? texelFetch(radiance, ivec2(pixel), 0) : scaled_radiance(pixel, size);
    vec3 shown = linear.rgb * exposure;
#ifdef AUTOMATIC
    shown *= exposures[0].x;
#endif
    shown = tone_curve(curve, shown);
    if (encoded) shown = srgb_encode(shown);
    colour = vec4(shown, opaque ? 1.0 : linear.a);
}
