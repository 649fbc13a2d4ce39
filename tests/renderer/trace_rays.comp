// Traces the rays of a buffer through the uploaded scene: see trace_rays_test.cpp.
#include "scene/bvh.glsl"

layout(local_size_x = 32) in;

struct TestRay {
    vec3 origin;
    float t_max;
    vec3 direction;
    float pad0;
};

layout(std430, binding = BINDING_LAST + 1) readonly restrict buffer Rays { TestRay rays[]; };
struct TestHit {
    vec3 front;  // of any length
    float t;
    uint triangle;  // index
    uint instance;  // node
    uint pad0;
    uint pad1;
};

layout(std430, binding = BINDING_LAST + 2) writeonly restrict buffer Hits { TestHit hits[]; };

uniform uint ray_count;

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= ray_count) return;
    Hit hit = closest_hit(rays[i].origin, rays[i].direction, 0.0, rays[i].t_max);
    vec3 front = hit.triangle == NO_TRIANGLE ? vec3(0.0) : front_of(hit);
    hits[i] = TestHit(front, hit.t, hit.triangle, hit.instance, 0u, 0u);
}
