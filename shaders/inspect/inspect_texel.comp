// The values of one texel of what is inspected. One invocation.
#include "inspect/inspected.glsl"

layout(local_size_x = 1) in;

// All channels; then metres, if it is a depth and there is a surface, else 0.
layout(std430, binding = BINDING_INSPECTED_TEXEL) writeonly restrict buffer Values { vec4 values[]; };

uniform uvec2 texel;

void main() {
    uvec2 at = min(texel, texels - 1u);
    Inspected read = inspected(at);
    values[0] = texel_at(at);
    values[1] = vec4(has_metres && !read.nothing ? read.value.r : 0.0, 0.0, 0.0, 0.0);
}
