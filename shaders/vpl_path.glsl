// Paths of light from a light from surface to surface, one segment at a time, for those who place VPLs and for those who
// test whether VPLs can stay.
#include "bvh.glsl"
#include "emission.glsl"

layout(std430, binding = BINDING_LIGHTS) readonly restrict buffer Lights { Light lights[]; };

uniform float ray_offset;  // metres, off the surface

struct Ray {
    vec3 origin;
    vec3 direction;  // unit
};

// What a segment that carries `throughput` times its light's flux finds at its end.
VplRecord follow(Ray ray, vec3 throughput) {
    Hit hit = closest_hit(ray.origin, ray.direction, 0.0, 1.0 / 0.0);
    if (hit.triangle == NO_TRIANGLE) return VplRecord(ray.origin, VPL_ESCAPED, ray.direction, 0.0, vec3(0.0), 0.0);
    TraceTriangle triangle = triangles[hit.triangle];
    vec3 front = normalize(cross(triangle.edge_ab, triangle.edge_ac));
    bool from_front = dot(front, ray.direction) < 0.0;
    vec3 normal = from_front ? front : -front;
    vec3 albedo = from_front || is_double_sided(triangle.material) ? hit_colour(triangle, hit.barycentric).rgb : vec3(0.0);
    vec3 position = triangle.a + hit.barycentric.x * triangle.edge_ab + hit.barycentric.y * triangle.edge_ac;
    return VplRecord(position, VPL_PLACED, normal, 0.0, throughput * albedo, 0.0);
}

// Segment of a path from the light on; `u` in [0, 1]².
Ray first_segment(Light light, vec2 u) {
    Ray ray;
    sample_emission(light, u, ray.origin, ray.direction);
    return ray;
}

// Segment of path `index` from its VPL of this bounce on.
Ray next_segment(VplRecord vpl, uint index, uint bounce, uint seed) {
    return Ray(vpl.position + ray_offset * vpl.normal, cosine_direction(vpl.normal, sample_2d(index, bounce, seed)));
}

// Where path `index` of a light's sequence starts.
vec2 canonical_start(uint index, uint seed) { return sample_2d(index, 0u, seed); }
