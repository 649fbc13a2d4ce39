// Tests whether paths of an earlier frame still hold: Laine et al., "Incremental Instant Radiosity for Real-Time Indirect
// Illumination" (EGSR 2007), section 4, there for the first bounce. One invocation a path. Gives how many of its leading
// bounces stay, and where on its light the path starts, as the light is now.
#include "bindings.glsl"
#include "types.glsl"
#include "vpl_path.glsl"

layout(local_size_x = 32) in;

layout(std430, binding = BINDING_PATHS) readonly restrict buffer Paths { CheckedPath paths[]; };
layout(std430, binding = BINDING_VPL_PLACES) readonly restrict buffer Tiles { uint tiles[]; };
layout(std430, binding = BINDING_VPL_RECORDS) restrict buffer Records { VplRecord records[]; };
layout(std430, binding = BINDING_PATH_CHECKS) writeonly restrict buffer Checks { PathCheck checks[]; };

uniform uint path_count;

// The ray from the light as it is now to the path's first end.
Ray aimed_first(Light light, VplRecord record) {
    if (light.kind == LIGHT_DIRECTIONAL) {
        float along = dot(record.position - light.position, light.direction);
        return Ray(record.position - along * light.direction, light.direction);
    }
    if (record.state == VPL_ESCAPED) return Ray(light.position, record.normal);
    vec3 to_vpl = record.position - light.position;
    float length2 = dot(to_vpl, to_vpl);
    return Ray(light.position, length2 > 0.0 ? to_vpl * inversesqrt(length2) : -record.normal);
}

// Whether a segment ends where it did. Across the surface half of the offset with which rays leave it is allowed, so
// that a VPL never sinks into what it sits on; along the surface more, for the rounding of grazing rays.
bool same_end(VplRecord old, VplRecord now) {
    if (old.state != now.state) return false;
    if (old.state == VPL_ESCAPED) return true;
    vec3 offset = now.position - old.position;
    return dot(old.normal, now.normal) > 0.9999 && abs(dot(offset, old.normal)) <= 0.5 * ray_offset &&
           dot(offset, offset) <= 256.0 * ray_offset * ray_offset;
}

bool same_throughput(VplRecord a, VplRecord b) {
    return all(lessThanEqual(abs(a.throughput - b.throughput), vec3(1e-5)));
}

void main() {
    uint id = gl_GlobalInvocationID.x;
    if (id >= path_count) return;
    CheckedPath path = paths[id];
    Light light = lights[path.light];
    vec2 canonical = canonical_start(path.index, path.seed);
    bool exact = path.canonical != 0u;

    PathCheck check = PathCheck(canonical, canonical, path.bounces, 0u);
    if (path.bounces > 0u && !exact) {
        Ray aimed = aimed_first(light, records[tiles[path.first_tile]]);
        check.start = emission_coordinates(light, aimed.origin, aimed.direction);
        if (!is_emitted(check.start)) check.bounces = 0u;
        check.start = clamp(check.start, 0.0, 1.0);
    }

    vec3 throughput = vec3(1.0);
    VplRecord last;
    for (uint bounce = 1u; bounce <= min(path.tested, check.bounces); ++bounce) {
        uint tile = tiles[path.first_tile + bounce - 1u];
        VplRecord old = records[tile];
        Ray ray;
        if (bounce > 1u) {
            ray = next_segment(last, path.index, bounce - 1u, path.traced_seed);
        } else if (exact) {
            ray = first_segment(light, canonical);
        } else {
            ray = aimed_first(light, old);
        }
        VplRecord now = follow(ray, throughput);
        if (!same_end(old, now)) {
            check.bounces = bounce - 1u;
            break;
        }
        // What was traced from where it still starts comes out as it would be traced now, to the last bit. Other paths
        // keep their places, and take over what colour the surface may have got.
        VplRecord kept = old;
        if (exact) kept = now;
        if (!exact && !same_throughput(old, now)) kept.throughput = now.throughput;
        records[tile] = kept;
        if (kept.state == VPL_ESCAPED) break;
        throughput = kept.throughput;
        last = kept;
    }
    checks[id] = check;
}
