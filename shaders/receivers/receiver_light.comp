// Irradiance at points of the host's: of lights, with their shadows, and of VPLs (VPLS). One invocation per receiver.
#include "bindings.glsl"
#include "indirect/gathered.glsl"
#include "lights/lights.glsl"
#include "lights/shadow.glsl"
#include "loop_part.glsl"
#include "surfaces/surface.glsl"
#include "types.glsl"
#ifdef VPLS
#include "indirect/vpl_light.glsl"
#endif

layout(local_size_x = RECEIVER_GROUP) in;

layout(std430, binding = BINDING_RECEIVERS) readonly restrict buffer Receivers { LightReceiver receivers[]; };
layout(std430, binding = BINDING_RECEIVED) restrict buffer Received { vec4 received[]; };

uniform uint receiver_count;
// Of the lights that this dispatch adds. Else it adds VPLs, as loop_part.glsl says in both cases.
uniform bool adds_lights;
uniform uint light_count;

// A small white surface without thickness, seen from the front.
Surface surface_at(LightReceiver receiver) {
    Surface surface;
    surface.position = receiver.position;
    surface.normal = receiver.normal;
    surface.albedo = vec3(1.0);
    surface.to_viewer = receiver.normal;
    surface.pixel = 0.0;
    return surface;
}

vec3 irradiance_from_light(uint index, Surface surface) {
    Light light = lights[index];
    Incident incident = incident_light(light, surface.position);
    float cosine = dot(face_normal(surface), incident.direction);
    if (cosine <= 0.0 || incident.irradiance == vec3(0.0)) return vec3(0.0);
    return incident.irradiance * (cosine * shadow_visibility(index, light, surface));
}

vec3 irradiance_from_lights(Surface surface) {
    vec3 sum = vec3(0.0);
    uint end = min(light_count, part_first + part_size);
    for (uint i = part_first; i < end; ++i) sum += irradiance_from_light(i, surface);
    return sum;
}

#ifdef VPLS

vec3 irradiance_from_vpls(Surface surface) {
    Surface surfaces[SURFACES];
    Gathered gathered[SURFACES];
    surfaces[0] = surface;
    gathered[0] = nothing_gathered();
    uint end = min(vpl_constants.count, part_first + part_size);
    for (uint i = part_first; i < end; ++i) add_vpl(i, surfaces, gathered);
    return gathered[0].irradiance / PI;
}

#else

vec3 irradiance_from_vpls(Surface surface) { return vec3(0.0); }

#endif

void main() {
    uint id = gl_GlobalInvocationID.x;
    if (id >= receiver_count) return;
    Surface surface = surface_at(receivers[id]);
    vec3 before = adds_lights && part_first == 0u ? vec3(0.0) : received[id].rgb;
    vec3 added = adds_lights ? irradiance_from_lights(surface) : irradiance_from_vpls(surface);
    received[id] = vec4(before + added, 1.0);
}
