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
layout(std430, binding = BINDING_LAST + 2) writeonly restrict buffer Hits { vec2 hits[]; };

uniform uint ray_count;

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= ray_count) return;
    Hit hit = closest_hit(rays[i].origin, rays[i].direction, 0.0, rays[i].t_max);
    hits[i] = vec2(hit.t, uintBitsToFloat(hit.triangle));
}
