// A picture of what is inspected. One invocation per pixel.
#include "inspect/heat_colours.glsl"
#include "inspect/inspected.glsl"
#include "maths.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba8, binding = IMAGE_INSPECTED) writeonly restrict uniform image2D picture;
layout(std430, binding = BINDING_INSPECTED_RANGES) readonly restrict buffer Ranges { vec4 ranges[]; };

// In the order of candela::Mapping.
const uint MAPPING_DEPTH = 2u;
const uint MAPPING_HEAT = 3u;

const vec3 FAULTY = vec3(1.0, 0.0, 1.0);

uniform uvec2 extent;      // of what is inspected, in texels, or pixels that the tiles cover
uniform uint texel_size;   // 1, or pixels along the edge of a tile
uniform uint mapping;
uniform bool automatic_range;
uniform vec2 chosen_range;

// From 0 to 1 within the range. An empty range is a threshold.
vec3 in_range(vec3 v) {
    vec2 range = automatic_range ? ranges[0].xy : chosen_range;
    vec3 above = mix(vec3(0.0), vec3(1.0), greaterThan(v, vec3(range.y)));
    return range.y > range.x ? clamp((v - range.x) / (range.y - range.x), 0.0, 1.0) : above;
}

vec3 heat_colour(float at) {
    const vec3 colours[HEAT_COLOUR_COUNT] = vec3[](HEAT_COLOURS);
    float place = at * float(HEAT_COLOUR_COUNT - 1);
    int first = min(int(place), HEAT_COLOUR_COUNT - 2);
    return mix(colours[first], colours[first + 1], place - float(first));
}

vec3 colour_of(Inspected read) {
    if (!read.finite) return FAULTY;
    if (read.nothing) return vec3(0.0);
    vec3 at = in_range(read.value);
    if (mapping == MAPPING_HEAT) return heat_colour(at.r);
    return mapping == MAPPING_DEPTH ? vec3(1.0 - at.r) : srgb_encode(at);
}

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    uvec2 size = uvec2(imageSize(picture));
    if (any(greaterThanEqual(pixel, size))) return;
    uvec2 nearest = (2u * pixel + 1u) * extent / (2u * size);
    imageStore(picture, ivec2(pixel), vec4(colour_of(inspected(nearest / texel_size)), 1.0));
}
