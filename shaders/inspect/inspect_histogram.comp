// How many values of what is inspected are in each of equal parts of the range that is shown. First, with `clear`, one
// work group; then one for each row of texels that counts.
#include "inspect/inspected.glsl"

layout(local_size_x = INSPECT_GROUP) in;

layout(std430, binding = BINDING_INSPECTED_RANGES) readonly restrict buffer Ranges { vec4 ranges[]; };
// The parts of the first channel, then those of the others; only the first one unless RGB is shown.
layout(std430, binding = BINDING_INSPECTED_HISTOGRAM) restrict buffer Histogram { uint counts[]; };

const uint BINS = 3u * INSPECT_BINS;

uniform bool clear;
uniform uint between;  // texels across and up from one that counts to the next
uniform bool automatic_range;
uniform vec2 chosen_range;

shared uint parts[BINS];

void count_texel(uvec2 at, vec2 range) {
    Inspected read = inspected(at);
    if (read.nothing || !read.finite) return;
    vec3 place = (read.value - range.x) / max(range.y - range.x, 1e-30);
    uint channel_count = channels == CHANNELS_RGB && !has_metres ? 3u : 1u;
    for (uint channel = 0u; channel < channel_count; ++channel) {
        float at_place = place[channel];
        if (at_place < 0.0 || at_place > 1.0) continue;
        uint bin = min(uint(at_place * float(INSPECT_BINS)), uint(INSPECT_BINS) - 1u);
        atomicAdd(parts[channel * INSPECT_BINS + bin], 1u);
    }
}

void main() {
    uint own = gl_LocalInvocationID.x;
    for (uint i = own; i < BINS; i += INSPECT_GROUP) {
        if (clear) counts[i] = 0u;
        parts[i] = 0u;
    }
    memoryBarrierShared();
    barrier();
    vec2 range = automatic_range ? ranges[0].xy : chosen_range;
    uint end = clear ? 0u : texels.x;
    for (uint x = own * between; x < end; x += INSPECT_GROUP * between) {
        count_texel(uvec2(x, gl_WorkGroupID.x * between), range);
    }
    memoryBarrierShared();
    barrier();
    for (uint i = own; i < BINS; i += INSPECT_GROUP) {
        if (parts[i] > 0u) atomicAdd(counts[i], parts[i]);
    }
}
