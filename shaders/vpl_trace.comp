// Traces paths of light from the lights, one segment a dispatch: Keller, "Instant Radiosity" (1997). One invocation a path.
// Blended surfaces are not among the triangles: light passes through them unchanged. Where a path goes is recorded without
// its flux, so that a later frame can keep the leading bounces that are still right and give them other flux.
#include "bindings.glsl"
#include "types.glsl"
#include "vpl_path.glsl"

layout(local_size_x = 32) in;

layout(std430, binding = BINDING_PATHS) readonly restrict buffer Paths { Path paths[]; };
layout(std430, binding = BINDING_VPL_PLACES) readonly restrict buffer Places { VplPlace places[]; };
layout(std430, binding = BINDING_VPL_RECORDS) restrict buffer Records { VplRecord records[]; };

uniform uint path_count;
uniform uint bounce;  // at the segment's end, from 1 on

uint tile_of(Path path, uint of_bounce) { return places[path.first_vpl + of_bounce - 1u].tile; }

Ray segment(Path path, VplRecord last) {
    if (bounce > 1u) return next_segment(last, path.index, bounce - 1u, path.seed);
    vec2 start = path.start.x < 0.0 ? canonical_start(path.index, path.seed) : path.start;
    return first_segment(lights[path.light], start);
}

void main() {
    uint id = gl_GlobalInvocationID.x;
    if (id >= path_count) return;
    Path path = paths[id];
    if (bounce <= path.kept || bounce > path.bounces) return;
    VplRecord last = VplRecord(vec3(0.0), VPL_PLACED, vec3(0.0), 0.0, vec3(1.0), 0.0);
    if (bounce > 1u) last = records[tile_of(path, bounce - 1u)];
    if (last.state == VPL_ESCAPED) {
        // Bounces that a path no longer comes to are marked like the last that it came to.
        records[tile_of(path, bounce)] = last;
        return;
    }
    records[tile_of(path, bounce)] = follow(segment(path, last), last.throughput);
}
