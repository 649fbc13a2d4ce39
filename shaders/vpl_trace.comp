// Traces paths of light from the lights and leaves a VPL at every diffuse bounce: Keller, "Instant Radiosity" (1997).
// Blended surfaces are not among the triangles: light passes through them unchanged. One invocation a path; path and
// bounce give the VPL's place, so that the order is that of the paths. Where a path goes is recorded without its flux,
// so that a later frame can keep the leading bounces that are still right and give them other flux.
#include "bindings.glsl"
#include "types.glsl"
#include "vpl_edges.glsl"
#include "vpl_path.glsl"

layout(local_size_x = 32) in;

layout(std430, binding = BINDING_PATHS) readonly restrict buffer Paths { Path paths[]; };
layout(std430, binding = BINDING_VPL_PLACES) readonly restrict buffer Places { VplPlace places[]; };
layout(std430, binding = BINDING_VPL_RECORDS) restrict buffer Records { VplRecord records[]; };
layout(std430, binding = BINDING_VPLS) writeonly restrict buffer Vpls { Vpl vpls[]; };
layout(std430, binding = BINDING_FLUX) writeonly restrict buffer Flux { FluxAccount flux[]; };

uniform uint path_count;
uniform uint max_bounces;

Ray segment(Path path, Light light, VplRecord last, uint bounce) {
    if (bounce > 1u) return next_segment(last, path.index, bounce - 1u, path.seed);
    return first_segment(light, path.start.x < 0.0 ? canonical_start(path.index, path.seed) : path.start);
}

// The record of a bounce: kept, or made now.
VplRecord record_at(Path path, Light light, VplRecord last, uint bounce) {
    uint tile = places[path.first_vpl + bounce - 1u].tile;
    if (bounce <= path.kept) return records[tile];
    VplRecord record = follow(segment(path, light, last, bounce), last.throughput);
    records[tile] = record;
    return record;
}

// What of a ranged light arrives at its path's first VPL; the rest counts as escaped.
float first_window(Light light, VplRecord first) {
    if (light.kind == LIGHT_DIRECTIONAL || first.state == VPL_ESCAPED) return 1.0;
    return range_window(distance(light.position, first.position), light.range);
}

// Edges are looked for anew whenever VPLs are written: what stands around a kept one may have moved.
Vpl make_vpl(vec3 position, vec3 normal, vec3 flux, uint tile) {
    Vpl vpl = Vpl(position, tile, normal, 0.0, flux, 0.0, vec3(0.0), 0.0, vec3(0.0), 0.0);
    if (flux != vec3(0.0)) surface_edges(position, normal, vpl.edges_up, vpl.edges_down);
    return vpl;
}

void main() {
    uint id = gl_GlobalInvocationID.x;
    if (id >= path_count) return;
    Path path = paths[id];
    Light light = lights[path.light];

    for (uint i = 0u; i < path.vpl_count; ++i) {
        uint place = path.first_vpl + i;
        vpls[place] = make_vpl(vec3(0.0), vec3(0.0), vec3(0.0), places[place].tile);
    }
    FluxAccount account = FluxAccount(vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0), 0.0);
    VplRecord record = VplRecord(vec3(0.0), VPL_PLACED, vec3(0.0), 0.0, vec3(1.0), 0.0);
    float window = 1.0;
    vec3 reflected = vec3(0.0);  // at the bounce before
    for (uint bounce = 1u; bounce <= path.length; ++bounce) {
        VplPlace place = places[path.first_vpl + bounce - 1u];
        vec3 carried = path.flux * (place.weight * window) * record.throughput;
        if (bounce == 1u) {
            account.emitted = carried;
        } else {
            account.roulette -= carried - reflected;
        }
        record = record_at(path, light, record, bounce);
        if (record.state == VPL_ESCAPED) {
            account.escaped += carried;
            break;
        }
        if (bounce == 1u) {
            window = first_window(light, record);
            account.escaped += carried * (1.0 - window);
            carried *= window;
        }
        reflected = path.flux * (place.weight * window) * record.throughput;
        account.absorbed += carried - reflected;
        vpls[path.first_vpl + bounce - 1u] = make_vpl(record.position, record.normal, reflected, place.tile);

        if (bounce == max_bounces) {
            account.truncated += reflected;
        } else if (bounce == path.length) {
            account.roulette += reflected;
        }
    }
    flux[id] = account;
}
