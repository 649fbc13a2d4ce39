// Sends starts through the emission of lights and back.
#include "emission.glsl"

layout(local_size_x = 64) in;

struct Start {
    vec2 start;
    uint light;
    uint pad0;
};

layout(std430, binding = 0) readonly buffer Lights { Light lights[]; };
layout(std430, binding = 1) readonly buffer Starts { Start starts[]; };
layout(std430, binding = 2) writeonly buffer Results { vec4 results[]; };  // where it comes back, whether it is emitted

uniform uint start_count;

void main() {
    uint id = gl_GlobalInvocationID.x;
    if (id >= start_count) return;
    Light light = lights[starts[id].light];
    vec3 origin, direction;
    sample_emission(light, starts[id].start, origin, direction);
    vec2 back = emission_coordinates(light, origin, direction);
    results[id] = vec4(back, is_emitted(back) ? 1.0 : 0.0, is_emitted(emission_coordinates(light, origin, -direction)) ? 1.0 : 0.0);
}
