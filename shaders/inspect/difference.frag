// How far two pictures of the size of the target are apart: |a - b| times a factor, clamped to [0, 1]. One fragment per
// pixel of the target.
#include "bindings.glsl"

layout(binding = UNIT_FIRST_PICTURE) uniform sampler2D first_picture;
layout(binding = UNIT_SECOND_PICTURE) uniform sampler2D second_picture;

uniform float factor;
uniform vec2 target_origin;  // in the framebuffer, pixels

layout(location = 0) out vec4 colour;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy - target_origin);
    vec3 apart = abs(texelFetch(first_picture, pixel, 0).rgb - texelFetch(second_picture, pixel, 0).rgb);
    colour = vec4(clamp(factor * apart, 0.0, 1.0), 1.0);
}
