// What is inspected, texel by texel. LISTS: the lengths of light lists, with a texel for each tile; INTEGER: a texture
// of unsigned integers; neither: any other texture.
#include "bindings.glsl"

const int CHANNELS_RGB = 4;
const int CHANNELS_LUMINANCE = 5;

uniform uvec2 texels;       // across and up
uniform int channels;       // 0 to 3: a single one; or one of the constants above
uniform bool has_metres;    // the texture holds depths from which metres follow by depth_terms
uniform vec4 depth_terms;   // elements [2][2], [3][2], [2][3] and [3][3] of the projection that made them

#ifdef LISTS
layout(std430, binding = BINDING_LIST_COUNT) readonly restrict buffer ListCount { uint list_count[]; };
uniform uint first_slice;
uniform uint end_slice;

// The longest list of the slices.
vec4 texel_at(uvec2 at) {
    uint longest = 0u;
    for (uint slice = first_slice; slice < end_slice; ++slice) {
        longest = max(longest, list_count[(slice * texels.y + at.y) * texels.x + at.x]);
    }
    return vec4(float(longest));
}
#else
#ifdef INTEGER
layout(binding = UNIT_INSPECTED) uniform usampler2D inspected_texture;
#else
layout(binding = UNIT_INSPECTED) uniform sampler2D inspected_texture;
#endif

vec4 texel_at(uvec2 at) { return vec4(texelFetch(inspected_texture, ivec2(at), 0)); }
#endif

struct Inspected {
    vec3 value;    // the same in all channels unless they are RGB
    bool finite;
    bool nothing;  // a depth where there is no surface
};

vec3 selected(vec4 texel) {
    if (channels == CHANNELS_RGB) return texel.rgb;
    if (channels == CHANNELS_LUMINANCE) return vec3(dot(texel.rgb, vec3(0.2126, 0.7152, 0.0722)));
    return vec3(texel[channels]);
}

// By the bits, because compilers may assume that there are no such values.
bool is_finite(vec3 v) {
    return all(notEqual(floatBitsToUint(v) & uvec3(0x7f800000u), uvec3(0x7f800000u)));
}

Inspected inspected(uvec2 at) {
    vec4 texel = texel_at(at);
    if (!has_metres) {
        vec3 value = selected(texel);
        return Inspected(value, is_finite(value), false);
    }
    float depth = texel.r;
    vec3 metres = vec3((depth_terms.y - depth * depth_terms.w) / (depth_terms.x - depth * depth_terms.z));
    return Inspected(metres, depth == 0.0 || is_finite(metres), depth == 0.0);
}
