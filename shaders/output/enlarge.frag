// Draws a picture to a target that has more pixels, with the weights of enlarge_weights.frag. One fragment per pixel of
// the target.
#include "bindings.glsl"
#include "output/enlarge.glsl"

layout(binding = UNIT_RADIANCE) uniform sampler2D picture;
layout(binding = UNIT_PICTURE_WEIGHTS) uniform sampler2D picture_weights;

uniform vec2 target_origin;  // in the framebuffer, pixels

layout(location = 0) out vec4 colour;

void main() {
    vec2 pixel = gl_FragCoord.xy - target_origin;
    vec2 size = vec2(textureSize(picture, 0));
    vec2 first = floor(picture_position(pixel, vec2(textureSize(picture_weights, 0)), size));
    ivec2 low = ivec2(max(first, 0.0));
    ivec2 high = ivec2(min(first + 1.0, size - 1.0));
    vec4 weights = texelFetch(picture_weights, ivec2(pixel), 0);
    colour = weights.x * texelFetch(picture, low, 0) + weights.y * texelFetch(picture, ivec2(high.x, low.y), 0) +
             weights.z * texelFetch(picture, ivec2(low.x, high.y), 0) + weights.w * texelFetch(picture, high, 0);
    colour /= weights.x + weights.y + weights.z + weights.w;  // of 8 bits each
}
