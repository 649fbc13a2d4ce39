// The least and the greatest value of what is inspected. One work group for each row of texels, then, with `finish`,
// one for the results of all rows.
#include "inspect/inspected.glsl"

layout(local_size_x = INSPECT_GROUP) in;

// Low and high: of the whole, then row by row. Low is above high where there is no value.
layout(std430, binding = BINDING_INSPECTED_RANGES) restrict buffer Ranges { vec2 ranges[]; };

uniform bool finish;
uniform bool from_zero;  // the range of the whole includes 0

shared vec2 parts[INSPECT_GROUP];

vec2 merged(vec2 a, vec2 b) { return vec2(min(a.x, b.x), max(a.y, b.y)); }

vec2 with_texel(vec2 range, uvec2 at) {
    Inspected read = inspected(at);
    if (read.nothing || !read.finite) return range;
    vec3 v = read.value;
    return merged(range, vec2(min(v.x, min(v.y, v.z)), max(v.x, max(v.y, v.z))));
}

vec2 whole_range(vec2 range) {
    if (range.x > range.y) return vec2(0.0);
    return from_zero ? merged(range, vec2(0.0)) : range;
}

void main() {
    uint row = gl_WorkGroupID.x;
    uint own = gl_LocalInvocationID.x;
    float infinite = uintBitsToFloat(0x7f800000u);
    vec2 range = vec2(infinite, -infinite);
    for (uint i = own; i < (finish ? texels.y : texels.x); i += INSPECT_GROUP) {
        range = finish ? merged(range, ranges[1u + i]) : with_texel(range, uvec2(i, row));
    }
    parts[own] = range;
    for (uint others = INSPECT_GROUP / 2; others > 0u; others /= 2u) {
        barrier();
        if (own < others) parts[own] = merged(parts[own], parts[own + others]);
    }
    if (own > 0u) return;
    if (finish) {
        ranges[0] = whole_range(parts[0]);
    } else {
        ranges[1u + row] = parts[0];
    }
}
