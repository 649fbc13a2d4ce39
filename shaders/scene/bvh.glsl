// Traversal of the bounding-volume hierarchy. Uses the same formulas as engine/bvh, with one addition: rays pass
// through the holes of alpha masks.
#include "bindings.glsl"
#include "scene/materials.glsl"
#include "types.glsl"

layout(std430, binding = BINDING_BVH_NODES) readonly restrict buffer BvhNodes { BvhNode bvh_nodes[]; };
layout(std430, binding = BINDING_TRIANGLES) readonly restrict buffer Triangles { TraceTriangle triangles[]; };

struct Hit {
    float t;
    vec2 barycentric;  // weights of b and c
    uint triangle;     // in the triangle buffer
};

const uint NO_TRIANGLE = 0xffffffffu;

// Distance at which the ray enters the box, or infinity if it misses. Slab test of Kay and Kajiya.
float enter_box(vec3 lower, vec3 upper, vec3 origin, vec3 inverse_direction, float t_min, float t_max) {
    vec3 t0 = (lower - origin) * inverse_direction;
    vec3 t1 = (upper - origin) * inverse_direction;
    vec3 near = min(t0, t1);
    vec3 far = max(t0, t1);
    float enter = max(max(near.x, near.y), max(near.z, t_min));
    float leave = min(min(far.x, far.y), min(far.z, t_max));
    // Tolerates the rounding error of the products (Ize, "Robust BVH Ray Traversal", 2013).
    return enter <= leave * 1.00001 ? enter : 1.0 / 0.0;
}

// Inverse of a direction. Components near zero are replaced by ±1e-20, as 0 × infinity would be NaN in the slab test.
vec3 safe_inverse(vec3 direction) {
    const float tiny = 1e-20;
    vec3 safe = mix(direction, mix(vec3(tiny), vec3(-tiny), lessThan(direction, vec3(0.0))),
                    lessThan(abs(direction), vec3(tiny)));
    return 1.0 / safe;
}

// Two-sided test of Möller and Trumbore (1997). Keeps the nearer of two hits; at equal distance the one with the lower
// id.
void intersect_triangle(uint index, vec3 origin, vec3 direction, float t_min, inout Hit hit) {
    TraceTriangle triangle = triangles[index];
    vec3 p = cross(direction, triangle.edge_ac);
    float determinant = dot(triangle.edge_ab, p);
    if (determinant == 0.0) return;
    float inverse = 1.0 / determinant;
    vec3 s = origin - triangle.a;
    float u = dot(s, p) * inverse;
    vec3 q = cross(s, triangle.edge_ab);
    float v = dot(direction, q) * inverse;
    float t = dot(triangle.edge_ac, q) * inverse;
    if (u < 0.0 || v < 0.0 || u + v > 1.0 || t <= t_min) return;
    bool nearer = t < hit.t;
    bool tie = t == hit.t && hit.triangle != NO_TRIANGLE && triangle.id < triangles[hit.triangle].id;
    if ((nearer || tie) && !is_hole(triangle, vec2(u, v))) hit = Hit(t, vec2(u, v), index);
}

// A triangle hit at t in (t_min, t_max), from either side: the nearest one, or with `any` the first one found.
Hit trace(vec3 origin, vec3 direction, float t_min, float t_max, bool any) {
    Hit hit = Hit(t_max, vec2(0.0), NO_TRIANGLE);
    vec3 inverse_direction = safe_inverse(direction);
    uint stack[BVH_STACK_SIZE];
    uint depth = 0u;
    uint node = 0u;
    bool going = true;
    while (going) {
        uint first = bvh_nodes[node].first;
        uint count = bvh_nodes[node].count;
        for (uint i = 0u; i < count; ++i) intersect_triangle(first + i, origin, direction, t_min, hit);

        if (any && hit.triangle != NO_TRIANGLE) return hit;

        bool descend = false;
        if (count == 0u) {
            BvhNode left = bvh_nodes[first];
            BvhNode right = bvh_nodes[first + 1u];
            float t_left = enter_box(left.lower, left.upper, origin, inverse_direction, t_min, hit.t);
            float t_right = enter_box(right.lower, right.upper, origin, inverse_direction, t_min, hit.t);
            bool left_first = t_left <= t_right;
            float t_near = min(t_left, t_right);
            float t_far = max(t_left, t_right);
            descend = !isinf(t_near);
            if (descend) node = left_first ? first : first + 1u;
            if (!isinf(t_far)) stack[depth++] = left_first ? first + 1u : first;
        }
        if (!descend) {
            going = depth > 0u;
            if (going) node = stack[--depth];
        }
    }
    return hit;
}

// Nearest triangle hit at t in (t_min, t_max), from either side; `triangle` is NO_TRIANGLE if there is none.
Hit closest_hit(vec3 origin, vec3 direction, float t_min, float t_max) {
    return trace(origin, direction, t_min, t_max, false);
}

// Whether any triangle is hit at t in (t_min, t_max).
bool any_hit(vec3 origin, vec3 direction, float t_min, float t_max) {
    return trace(origin, direction, t_min, t_max, true).triangle != NO_TRIANGLE;
}
