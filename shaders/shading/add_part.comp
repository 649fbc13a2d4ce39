// Adds the picture of a part of the light on blended surfaces to the radiance. One invocation per pixel.
#include "bindings.glsl"

layout(local_size_x = PIXEL_BLOCK, local_size_y = PIXEL_BLOCK) in;

layout(binding = UNIT_PART) uniform sampler2D part;
layout(rgba32f, binding = IMAGE_RADIANCE) restrict uniform image2D radiance;

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, imageSize(radiance)))) return;
    imageStore(radiance, at, imageLoad(radiance, at) + vec4(texelFetch(part, at, 0).rgb, 0.0));
}
