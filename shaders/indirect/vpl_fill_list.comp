// Lists the pixels whose bits are set in the fill mask, row by row: those without enough neighbours on the same surface.
// One work group in all.
#include "bindings.glsl"

layout(local_size_x = LIST_GROUP) in;

layout(std430, binding = BINDING_FILL_MASK) readonly restrict buffer Mask { uint fill_mask[]; };
layout(std430, binding = BINDING_FILL_LIST) writeonly restrict buffer FillList {
    uint fill_groups[3];  // for an indirect dispatch
    uint fill_count;
    uint fill_pixels[];        // pixels: x in the lower half, y in the upper
};

uniform uint mask_words;
uniform uint row_words;

shared uint counts[LIST_GROUP];  // set bits in each invocation's range of mask words

void main() {
    uint id = gl_LocalInvocationID.x;
    uint stretch = (mask_words + LIST_GROUP - 1u) / LIST_GROUP;
    uint first = min(id * stretch, mask_words);
    uint last = min(first + stretch, mask_words);
    uint count = 0u;
    for (uint word = first; word < last; ++word) count += uint(bitCount(fill_mask[word]));
    counts[id] = count;
    memoryBarrierShared();
    barrier();
    uint index = 0u;
    for (uint i = 0u; i < id; ++i) index += counts[i];
    for (uint word = first; word < last; ++word) {
        for (uint bits = fill_mask[word]; bits != 0u; bits &= bits - 1u) {
            uint x = 32u * (word % row_words) + uint(findLSB(bits));
            fill_pixels[index++] = x | (word / row_words) << 16;
        }
    }
    if (id == LIST_GROUP - 1u) {
        fill_count = index;
        fill_groups[0] = (index + FILL_GROUP - 1u) / FILL_GROUP;
        fill_groups[1] = 1u;
        fill_groups[2] = 1u;
    }
}
