// Traces light paths from the lights, one segment a dispatch (Keller, "Instant Radiosity", 1997). One invocation a
// path. The hierarchy holds no blended surfaces: light passes through them unchanged.
#include "bindings.glsl"
#include "maths.glsl"
#include "scene/bvh.glsl"
#include "lights/lights.glsl"
#include "types.glsl"

layout(local_size_x = 32) in;

layout(std430, binding = BINDING_PATHS) readonly restrict buffer Paths { Path paths[]; };
layout(std430, binding = BINDING_VPL_RECORDS) restrict buffer Records { VplRecord records[]; };

uniform uint path_count;
uniform uint bounce;  // number of the bounce at the segment's end, from 1
uniform float ray_offset;  // metres above the surface, where rays start

struct Ray {
    vec3 origin;
    vec3 direction;  // unit
};

// The bounce at the end of a segment; `throughput` is the product of the albedos before it.
VplRecord follow(Ray ray, vec3 throughput) {
    Hit hit = closest_hit(ray.origin, ray.direction, 0.0, INFINITY);
    if (hit.triangle == NO_TRIANGLE) return VplRecord(ray.origin, VPL_ESCAPED, ray.direction, 0.0, vec3(0.0), 0.0);
    TraceTriangle triangle = triangle_at(hit.triangle);
    vec3 front = normalize(front_of(hit));
    bool from_front = dot(front, ray.direction) < 0.0;
    vec3 normal = from_front ? front : -front;
    vec3 albedo = from_front || is_double_sided(triangle.material) ? traced_albedo(materials[triangle.material], hit_colour(triangle, hit.barycentric).rgb) : vec3(0.0);
    return VplRecord(ray.origin + hit.t * ray.direction, VPL_PLACED, normal, 0.0, throughput * albedo, 0.0);
}

// First segment of a path, from the light; `u` in [0, 1)².
Ray first_segment(Light light, vec2 u) {
    Emission emission = sample_emission(light, u);
    return Ray(emission.origin, emission.direction);
}

// Segment of path `index` that starts at its VPL of bounce `bounce`.
Ray next_segment(VplRecord vpl, uint index, uint bounce, uint seed) {
    return Ray(vpl.position + ray_offset * vpl.normal, cosine_direction(vpl.normal, sample_2d(index, bounce, seed)));
}

Ray segment(Path path, VplRecord last) {
    if (bounce > 1u) return next_segment(last, path.index, bounce - 1u, path.seed);
    return first_segment(lights[path.light], sample_2d(path.index, 0u, path.seed));
}

void main() {
    uint id = gl_GlobalInvocationID.x;
    if (id >= path_count) return;
    Path path = paths[id];
    if (bounce > path.vpl_count) return;
    uint place = path.first_vpl + bounce - 1u;
    VplRecord last = VplRecord(vec3(0.0), VPL_PLACED, vec3(0.0), 0.0, vec3(1.0), 0.0);
    if (bounce > 1u) last = records[place - 1u];
    // After a path has escaped, its remaining bounces get the same record.
    records[place] = last.state == VPL_ESCAPED ? last : follow(segment(path, last), last.throughput);
}
