// Running mean of the radiance of `count` frames, of which the target has that of those before. One fragment per pixel.
#include "bindings.glsl"

layout(binding = UNIT_RADIANCE) uniform sampler2D radiance;

uniform uint count;  // frames in the mean, this one included

layout(location = 0, index = 0) out vec4 added;
layout(location = 0, index = 1) out vec4 share;  // of this frame in the mean

void main() {
    share = vec4(1.0 / float(count));
    added = share * texelFetch(radiance, ivec2(gl_FragCoord.xy), 0);
}
