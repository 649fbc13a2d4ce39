// The least and the greatest value of what is inspected, and how many texels have values that are infinite or no
// numbers. One work group for each row of texels, then, with `finish`, one for the results of all rows.
#include "inspect/inspected.glsl"

layout(local_size_x = INSPECT_GROUP) in;

// Low, high and the number of faulty texels: the range that is shown; that of the values; then row by row. Low is above
// high where there is no value.
layout(std430, binding = BINDING_INSPECTED_RANGES) restrict buffer Ranges { vec4 ranges[]; };

uniform bool finish;
uniform bool from_zero;  // the range that is shown includes 0

shared vec3 parts[INSPECT_GROUP];

vec3 merged(vec3 a, vec3 b) { return vec3(min(a.x, b.x), max(a.y, b.y), a.z + b.z); }

vec3 with_texel(vec3 range, uvec2 at) {
    Inspected read = inspected(at);
    if (read.nothing) return range;
    if (!read.finite) return vec3(range.xy, range.z + 1.0);
    vec3 v = read.value;
    return merged(range, vec3(min(v.x, min(v.y, v.z)), max(v.x, max(v.y, v.z)), 0.0));
}

vec3 of_values(vec3 range) { return range.x > range.y ? vec3(0.0, 0.0, range.z) : range; }

void main() {
    uint row = gl_WorkGroupID.x;
    uint own = gl_LocalInvocationID.x;
    float infinite = uintBitsToFloat(0x7f800000u);
    vec3 range = vec3(infinite, -infinite, 0.0);
    for (uint i = own; i < (finish ? texels.y : texels.x); i += INSPECT_GROUP) {
        range = finish ? merged(range, ranges[2u + i].xyz) : with_texel(range, uvec2(i, row));
    }
    parts[own] = range;
    for (uint others = INSPECT_GROUP / 2; others > 0u; others /= 2u) {
        memoryBarrierShared();
        barrier();
        if (own < others) parts[own] = merged(parts[own], parts[own + others]);
    }
    if (own > 0u) return;
    if (finish) {
        vec3 whole = of_values(parts[0]);
        ranges[0] = vec4(from_zero ? merged(whole, vec3(0.0)) : whole, 0.0);
        ranges[1] = vec4(whole, 0.0);
    } else {
        ranges[2u + row] = vec4(parts[0], 0.0);
    }
}
