// Reconstructs the irradiance from all VPLs out of the gathered estimates, each of which covers one class's share:
// first along rows, then along columns of that result. Along a line the classes repeat every `interleave`
// pixels. Each class counts once, interpolated linearly between its two nearest pixels, as far as they lie on the same
// surface as the pixel. Alpha: the share of the classes that were found. See README.md, "Interpolation between
// classes". One invocation per pixel.
#include "bindings.glsl"
#include "surfaces/visible_surface.glsl"
#include "surfaces/tangent_plane.glsl"

layout(local_size_x = RECONSTRUCT_GROUP) in;

uniform uint interleave;
uniform bool columns;

ivec2 along = columns ? ivec2(0, 1) : ivec2(1, 0);

layout(binding = UNIT_INDIRECT) uniform sampler2D gathered;
layout(rgba32f, binding = IMAGE_INDIRECT) writeonly restrict uniform image2D reconstructed;
#ifdef DIRECTED
layout(binding = UNIT_INDIRECT_DIRECTION) uniform sampler2D gathered_flow;
layout(rgba32f, binding = IMAGE_INDIRECT_DIRECTION) writeonly restrict uniform image2D reconstructed_flow;
#endif

const float SAME_NORMAL = 0.9;  // smallest cosine between normals of the same surface
const float SAME_PLANE = 2.0;   // largest distance from the tangent plane, in widths of a pixel at that depth

#ifdef MIRRORED

struct Plane {
    vec3 normal;
    vec3 position;
    float pixel;
};

Plane plane_at(ivec2 at, float depth, Surface surface) {
    return Plane(face_normal(surface), surface.position, surface.pixel);
}

// Pixel widths from the plane to the surface at a pixel, `steps` pixels along.
float distance_off(Plane plane, ivec2 there, int steps) {
    return dot(plane.normal, texelFetch(surface_depth, there, 0).gba - plane.position) / plane.pixel;
}

#else

// Tangent plane of the surface at a pixel.
struct Plane {
    float step_off;  // change of the distance from it per pixel along, in pixel widths
    float by_depth;  // and per depth
    float depth;     // of the pixel
};

Plane plane_at(ivec2 at, float depth, Surface surface) {
    vec4 plane = tangent_plane(face_normal(surface), vec3((vec2(at) + 0.5) / view.target_size * 2.0 - 1.0, depth));
    return Plane(dot(plane.xy, 2.0 * vec2(along) / view.target_size), plane.z, depth);
}

float distance_off(Plane plane, ivec2 there, int steps) {
    return float(steps) * plane.step_off + plane.by_depth * (texelFetch(surface_depth, there, 0).r - plane.depth);
}

#endif

// A weighted sum over pixels.
struct Sum {
    vec4 irradiance;  // alpha: of the classes behind each pixel, which weights it, too
#ifdef DIRECTED
    vec4 flow;
#endif
};

#ifdef DIRECTED
Sum nothing_found() { return Sum(vec4(0.0), vec4(0.0)); }
#else
Sum nothing_found() { return Sum(vec4(0.0)); }
#endif

void add_pixel(inout Sum sum, ivec2 there, float weight) {
    vec4 found = texelFetch(gathered, there, 0);
    sum.irradiance += weight * vec4(found.rgb * found.a, found.a);
#ifdef DIRECTED
    sum.flow += weight * found.a * texelFetch(gathered_flow, there, 0);
#endif
}

void add_mean(inout Sum sum, Sum pixels, float weight) {
    sum.irradiance += pixels.irradiance / weight;
#ifdef DIRECTED
    sum.flow += pixels.flow / weight;
#endif
}

// Over the classes.
Sum reconstruct(ivec2 at) {
    float depth = texelFetch(surface_depth, at, 0).r;
    Surface surface = visible_surface(at, depth, vec3(0.0));
    Plane plane = plane_at(at, depth, surface);
    ivec2 before = at * along;
    ivec2 behind = (ivec2(view.target_size) - 1 - at) * along;
    int least = -(before.x + before.y);
    int most = behind.x + behind.y;

    Sum sum = nothing_found();
    int n = int(interleave);
    for (int offset = 0; offset < n; ++offset) {
        Sum value = nothing_found();  // of the class `offset` pixels on
        float fitting = 0.0;
        for (int side = 0; side < 2; ++side) {
            int d = side == 0 ? offset : offset - n;
            float weight = float(n - abs(d));
            if (d < least || d > most || weight == 0.0) continue;
            ivec2 there = at + d * along;
            vec3 normal = visible_face_normal(there);
            if (abs(distance_off(plane, there, d)) > SAME_PLANE || dot(normal, face_normal(surface)) < SAME_NORMAL) continue;
            add_pixel(value, there, weight);
            fitting += weight;
        }
        if (fitting > 0.0) add_mean(sum, value, fitting);
    }
    return sum;
}

// Irradiance of a pixel, and the share of the classes that it was interpolated from.
vec4 mean_irradiance(Sum sum) {
    return vec4(sum.irradiance.rgb / max(sum.irradiance.a, 1e-6), sum.irradiance.a / float(interleave));
}

// Only the step along columns writes it. One bit a pixel, 32 a word: 1 if vpl_fill.comp is to gather VPLs for the pixel.
layout(std430, binding = BINDING_FILL_MASK) writeonly restrict buffer Mask { uint fill_mask[]; };

const float ENOUGH = 0.6;  // share of the classes; with less, vpl_fill.comp gathers VPLs for the pixel

shared uint group_mask[RECONSTRUCT_GROUP / 32];

void mark_for_fill(bool needs_fill) {
    uint word = gl_LocalInvocationID.x / 32u;
    bool first = gl_LocalInvocationID.x % 32u == 0u;
    if (first) group_mask[word] = 0u;
    memoryBarrierShared();
    barrier();
    if (needs_fill) atomicOr(group_mask[word], 1u << (gl_LocalInvocationID.x % 32u));
    memoryBarrierShared();
    barrier();
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (first) fill_mask[group * (RECONSTRUCT_GROUP / 32) + word] = group_mask[word];
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    bool is_surface = at.x < int(view.target_size.x) && texelFetch(surface_depth, at, 0).r > 0.0;
    Sum sum = nothing_found();
    if (is_surface) sum = reconstruct(at);
    vec4 result = mean_irradiance(sum);
    imageStore(reconstructed, at, result);  // OpenGL discards stores outside the image
#ifdef DIRECTED
    imageStore(reconstructed_flow, at, sum.flow / max(sum.irradiance.a, 1e-6));
#endif
    if (columns) mark_for_fill(is_surface && result.a < ENOUGH);
}
