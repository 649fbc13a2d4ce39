// Maps radiance to display colours, or copies it; see Display in tone_map.hpp. One fragment per pixel of the target.
#include "bindings.glsl"
#include "maths.glsl"

layout(binding = UNIT_RADIANCE) uniform sampler2D radiance;

uniform float exposure;
uniform bool curve;
uniform bool encoded;
uniform bool opaque;
uniform vec2 target_origin;  // in the framebuffer, pixels
uniform vec2 target_size;

layout(location = 0) out vec4 colour;

// Narkowicz, "ACES Filmic Tone Mapping Curve" (2015). The bound of 1e4 keeps the squares finite; the curve is white
// long before it.
vec3 filmic(vec3 light) {
    vec3 x = min(light, 1e4);
    return clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
}

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
    if (curve) shown = filmic(shown);
    if (encoded) shown = srgb_encode(shown);
    colour = vec4(shown, opaque ? 1.0 : linear.a);
}
