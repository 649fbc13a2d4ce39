// Running mean of the radiance of `count` frames. One fragment per pixel.
#include "bindings.glsl"

layout(binding = UNIT_RADIANCE) uniform sampler2D radiance;
layout(binding = UNIT_MEAN) uniform sampler2D mean_before;

uniform uint count;   // frames in the mean, this one included

layout(location = 0) out vec4 mean;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec4 now = texelFetch(radiance, at, 0);
    mean = now;
    if (count > 1u) {
        vec4 before = texelFetch(mean_before, at, 0);
        mean = before + (now - before) / float(count);
    }
}
