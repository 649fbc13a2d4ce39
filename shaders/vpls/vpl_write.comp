// Writes a VPL for every bounce of the traced paths, and the account of their flux. One invocation per path. Path and
// bounce give the VPL's index, so VPLs are in the order of the paths.
#include "bindings.glsl"
#include "lights/lights.glsl"
#include "types.glsl"

layout(local_size_x = 32) in;

layout(std430, binding = BINDING_PATHS) readonly restrict buffer Paths { Path paths[]; };
layout(std430, binding = BINDING_PATH_WEIGHTS) readonly restrict buffer Weights { float weights[]; };
layout(std430, binding = BINDING_VPL_RECORDS) readonly restrict buffer Records { VplRecord records[]; };
layout(std430, binding = BINDING_TRACED_VPLS) writeonly restrict buffer TracedVpls { TracedVpl traced_vpls[]; };
layout(std430, binding = BINDING_FLUX) writeonly restrict buffer Flux { FluxAccount flux[]; };

uniform uint path_count;
uniform uint max_bounces;
uniform float radius2;  // m², of all VPLs

// Share of the flux that a light's range lets through to the path's first VPL; the rest counts as escaped.
float first_window(Light light, VplRecord first) {
    return first.state == VPL_ESCAPED ? 1.0 : share_in_range(light, first.position);
}

// vpl_edges.comp fills in the edges.
TracedVpl make_vpl(vec3 position, uint state, vec3 normal, vec3 flux) {
    return TracedVpl(position, state, normal, radius2, flux, 0.0, vec3(0.0), 0.0, vec3(0.0), 0.0);
}

void main() {
    uint id = gl_GlobalInvocationID.x;
    if (id >= path_count) return;
    Path path = paths[id];
    Light light = lights[path.light];

    for (uint i = 0u; i < path.vpl_count; ++i) {
        traced_vpls[path.first_vpl + i] = make_vpl(vec3(0.0), VPL_ESCAPED, vec3(0.0), vec3(0.0));
    }
    FluxAccount account = FluxAccount(vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0), 0.0, uvec3(0u), 0u,
                                      uvec3(0u), 0u);
    vec3 throughput = vec3(1.0);
    float window = 1.0;
    vec3 reflected = vec3(0.0);  // at the previous bounce
    for (uint bounce = 1u; bounce <= path.vpl_count; ++bounce) {
        uint place = path.first_vpl + bounce - 1u;
        float weight = weights[place];
        vec3 carried = path.flux * (weight * window) * throughput;
        if (bounce == 1u) {
            account.emitted = carried;
        } else {
            account.roulette -= carried - reflected;
        }
        VplRecord record = records[place];
        if (record.state == VPL_ESCAPED) {
            account.escaped += carried;
            break;
        }
        if (bounce == 1u) {
            window = first_window(light, record);
            account.escaped += carried * (1.0 - window);
            carried *= window;
        }
        throughput = record.throughput;
        reflected = path.flux * (weight * window) * throughput;
        account.absorbed += carried - reflected;
        traced_vpls[place] = make_vpl(record.position, VPL_PLACED, record.normal, reflected);

        if (bounce == max_bounces) {
            account.truncated += reflected;
        } else if (bounce == path.vpl_count) {
            account.roulette += reflected;
        }
    }
    flux[id] = account;
}
