// From what each pixel has gathered of its class's share of the VPLs, what it would have from all: along rows first, then
// (COLUMNS) along columns of the result. Along a line the classes repeat every `interleave` pixels, and each class is
// interpolated linearly between its two nearest pixels, as far as these lie on the same surface as the pixel in the middle,
// so that each class counts once. In alpha: the share of the classes that were found.
#include "bindings.glsl"
#include "visible_surface.glsl"

layout(local_size_x = RECONSTRUCT_GROUP) in;

#ifdef COLUMNS
const ivec2 along = ivec2(0, 1);
#else
const ivec2 along = ivec2(1, 0);
#endif

uniform uint interleave;

layout(binding = UNIT_INDIRECT) uniform sampler2D gathered;
layout(rgba32f, binding = IMAGE_INDIRECT) writeonly restrict uniform image2D reconstructed;

const float SAME_NORMAL = 0.9;  // least cosine between the normals of one surface
const float SAME_PLANE = 2.0;   // pixels, as wide as they are there: farther off a plane nothing counts as on it

// The tangent plane of the surface under a pixel, in clip space, scaled so that its product with a point (x, y, z, 1) is
// the distance from the plane in pixels' widths: with w the factor by which world_from_clip scales the point, the distance
// in metres is the plane's product over w, and a pixel is |column 1| · 2 / (height · w) metres wide.
vec4 tangent_plane(Surface surface) {
    vec4 plane = vec4(surface.normal, -dot(surface.normal, surface.position)) * view.world_from_clip;
    return plane * (0.5 * view.target_size.y / length(view.world_from_clip[1].xyz));
}

// Irradiance of the pixel in the middle, and the share of the classes that it is from.
vec4 reconstruct(ivec2 at) {
    float depth = texelFetch(surface_depth, at, 0).r;
    Surface surface = visible_surface(at, depth, vec3(0.0));
    vec4 plane = tangent_plane(surface);
    float step_off = dot(plane.xy, 2.0 * vec2(along) / view.target_size);  // how far a pixel more leads off the plane
    ivec2 before = at * along;
    ivec2 behind = (ivec2(view.target_size) - 1 - at) * along;
    int least = -(before.x + before.y);
    int most = behind.x + behind.y;

    vec4 sum = vec4(0.0);
    int n = int(interleave);
    for (int offset = 0; offset < n; ++offset) {
        vec4 value = vec4(0.0);  // of the class `offset` farther on: weighted by its weight in alpha
        float fitting = 0.0;
        for (int side = 0; side < 2; ++side) {
            int d = side == 0 ? offset : offset - n;
            float weight = float(n - abs(d));
            if (d < least || d > most || weight == 0.0) continue;
            ivec2 there = at + d * along;
            float z = texelFetch(surface_depth, there, 0).r;
            vec3 normal = octahedral_decode(texelFetch(surface_normal, there, 0).rg);
            float off_plane = float(d) * step_off + plane.z * (z - depth);
            if (abs(off_plane) > SAME_PLANE || dot(normal, surface.normal) < SAME_NORMAL) continue;
            vec4 found = texelFetch(gathered, there, 0);
            value += weight * vec4(found.rgb * found.a, found.a);
            fitting += weight;
        }
        if (fitting > 0.0) sum += value / fitting;
    }
    return vec4(sum.rgb / max(sum.a, 1e-6), sum.a / float(n));
}

#ifdef COLUMNS

layout(std430, binding = BINDING_LACKING_MASK) writeonly restrict buffer Mask { uint lacking_mask[]; };  // 32 pixels each

const float ENOUGH = 0.6;  // of the classes, for a pixel not to ask VPLs itself

shared uint group_mask[RECONSTRUCT_GROUP / 32];

void note_lacking(bool lacks) {
    uint word = gl_LocalInvocationID.x / 32u;
    bool first = gl_LocalInvocationID.x % 32u == 0u;
    if (first) group_mask[word] = 0u;
    barrier();
    if (lacks) atomicOr(group_mask[word], 1u << (gl_LocalInvocationID.x % 32u));
    barrier();
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (first) lacking_mask[group * (RECONSTRUCT_GROUP / 32) + word] = group_mask[word];
}

#endif

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    bool is_surface = at.x < int(view.target_size.x) && texelFetch(surface_depth, at, 0).r > 0.0;
    vec4 result = is_surface ? reconstruct(at) : vec4(0.0);
    imageStore(reconstructed, at, result);  // beyond the target it is discarded by the GL
#ifdef COLUMNS
    note_lacking(is_surface && result.a < ENOUGH);
#endif
}
