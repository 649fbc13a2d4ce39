// Irradiance at points of the host's. One invocation per receiver.
#include "bindings.glsl"
#include "loop_part.glsl"
#include "receivers/light_at_point.glsl"
#include "types.glsl"

layout(local_size_x = RECEIVER_GROUP) in;

layout(std430, binding = BINDING_RECEIVERS) readonly restrict buffer Receivers { LightReceiver receivers[]; };
layout(std430, binding = BINDING_RECEIVED) restrict buffer Received { vec4 received[]; };

uniform uint receiver_count;
uniform bool adds_lights;  // or VPLs: those that loop_part.glsl says

void main() {
    uint id = gl_GlobalInvocationID.x;
    if (id >= receiver_count) return;
    Surface surface = surface_at(receivers[id].position, receivers[id].normal);
    uint end = part_first + part_size;
    vec3 sum = adds_lights && part_first == 0u ? vec3(0.0) : received[id].rgb;
    sum += adds_lights ? irradiance_from_lights(part_first, end, surface)
                       : irradiance_from_vpls(part_first, end, 1u, surface);
    received[id] = vec4(sum, 1.0);
}
