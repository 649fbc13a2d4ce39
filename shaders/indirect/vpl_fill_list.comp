// Lists the pixels whose bits are set in the fill mask, row by row: those without enough neighbours on the same surface.
// Each work group lists LIST_GROUP * LIST_WORDS words of the mask. It counts the bits of all words before them itself, so
// that the list has the same order in every frame and no group waits for another.
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

// Set bits that each invocation has counted: in a part of the words before the group's, and in its own words.
shared uint counts_before[LIST_GROUP];
shared uint counts[LIST_GROUP];

uint count_bits(uint first, uint last, uint step) {
    uint count = 0u;
    for (uint word = first; word < last; word += step) count += uint(bitCount(fill_mask[word]));
    return count;
}

// Index in the list of the first pixel in an invocation's own words.
uint first_index(uint invocation) {
    uint index = 0u;
    for (uint i = 0u; i < LIST_GROUP; ++i) index += counts_before[i] + (i < invocation ? counts[i] : 0u);
    return index;
}

void main() {
    uint id = gl_LocalInvocationID.x;
    uint first_of_group = gl_WorkGroupID.x * LIST_GROUP * LIST_WORDS;
    uint first = min(first_of_group + id * LIST_WORDS, mask_words);
    uint last = min(first + LIST_WORDS, mask_words);
    counts_before[id] = count_bits(id, first_of_group, LIST_GROUP);
    counts[id] = count_bits(first, last, 1u);
    memoryBarrierShared();
    barrier();
    uint index = first_index(id);
    for (uint word = first; word < last; ++word) {
        for (uint bits = fill_mask[word]; bits != 0u; bits &= bits - 1u) {
            uint x = 32u * (word % row_words) + uint(findLSB(bits));
            fill_pixels[index++] = x | (word / row_words) << 16;
        }
    }
    if (gl_WorkGroupID.x == gl_NumWorkGroups.x - 1u && id == LIST_GROUP - 1u) {
        fill_count = index;
        fill_groups[0] = (index + FILL_GROUP - 1u) / FILL_GROUP;
        fill_groups[1] = 1u;
        fill_groups[2] = 1u;
    }
}
