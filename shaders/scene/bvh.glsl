// Traversal of the bounding-volume hierarchy over instances of meshes, which has up to four children a node:
// engine/bvh/wide.hpp. Rays are in world space; they pass through the holes of alpha masks.
#include "bindings.glsl"
#include "maths.glsl"
#include "scene/materials.glsl"
#include "types.glsl"

layout(binding = UNIT_BVH_NODES) uniform usamplerBuffer node_texels;
layout(binding = UNIT_TRIANGLES) uniform usamplerBuffer triangle_texels;

WideNode node_at(uint index) {
    int first = 4 * int(index);
    uvec4 words = texelFetch(node_texels, first);
    return WideNode(uintBitsToFloat(words.xyz), words.w, texelFetch(node_texels, first + 1), texelFetch(node_texels, first + 2),
                    texelFetch(node_texels, first + 3));
}

TraceTriangle triangle_at(uint index) {
    uvec4 words[6];
    for (int i = 0; i < 6; ++i) {
        words[i] = texelFetch(triangle_texels, 6 * int(index) + i);
    }
    return TraceTriangle(uintBitsToFloat(words[0].xyz), words[0].w, uintBitsToFloat(words[1].xyz), words[1].w,
                         uintBitsToFloat(words[2].xyz), words[2].w, uintBitsToFloat(words[3].xy),
                         uintBitsToFloat(words[3].zw), uintBitsToFloat(words[4].xy), words[4].z, words[4].w, words[5].x,
                         words[5].y, words[5].z, words[5].w);
}

struct Hit {
    float t;
    vec2 barycentric;  // weights of b and c
    uint triangle;     // in the triangle buffer
    uint id;           // of the triangle
    uint instance;     // node
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
    return enter <= leave * 1.00001 ? enter : INFINITY;
}

// Inverse of a direction. Components near zero are replaced by ±1e-20, as 0 × infinity would be NaN in the slab test.
vec3 safe_inverse(vec3 direction) {
    const float tiny = 1e-20;
    vec3 safe = mix(direction, mix(vec3(tiny), vec3(-tiny), lessThan(direction, vec3(0.0))),
                    lessThan(abs(direction), vec3(tiny)));
    return 1.0 / safe;
}

// A ray in the space of a mesh, or of the world. The distance along it is the same in all spaces.
struct LocalRay {
    vec3 origin;
    vec3 direction;
    vec3 inverse;   // of the direction
    uint instance;  // node; 0: none, in world space
};

// The rows of the matrix that leads from the world to an instance's mesh.
vec4[3] mesh_from_world(WideNode instance) {
    return vec4[3](vec4(instance.origin, uintBitsToFloat(instance.exponents)), uintBitsToFloat(instance.lower),
                   uintBitsToFloat(instance.upper));
}

// Turns a normal of the mesh that was hit to world space. The result is not normalised.
vec3 to_world(Hit hit, vec3 normal) {
    vec4 rows[3] = mesh_from_world(node_at(hit.instance));
    return normal.x * rows[0].xyz + normal.y * rows[1].xyz + normal.z * rows[2].xyz;
}

vec3 to_mesh(vec4 rows[3], vec4 place) { return vec3(dot(rows[0], place), dot(rows[1], place), dot(rows[2], place)); }

// Whether `found` comes before `hit`: it is nearer, or as near and its entity has the lower index, or is the same and the
// triangle has the lower id. This does not depend on what has come and gone before.
bool comes_first(Hit found, Hit hit) {
    if (found.t < hit.t || hit.triangle == NO_TRIANGLE) return found.t < hit.t;
    uint entity = node_at(found.instance).children.y;
    uint other = node_at(hit.instance).children.y;
    return entity < other || (entity == other && found.id < hit.id);
}

// Two-sided test of Möller and Trumbore (1997). Returns whether the triangle is hit no farther away than `hit`; then it
// becomes the hit.
bool intersect_triangle(uint index, LocalRay ray, float t_min, inout Hit hit) {
    TraceTriangle triangle = triangle_at(index);
    vec3 p = cross(ray.direction, triangle.edge_ac);
    float determinant = dot(triangle.edge_ab, p);
    if (determinant == 0.0) return false;
    float inverse = 1.0 / determinant;
    vec3 s = ray.origin - triangle.a;
    float u = dot(s, p) * inverse;
    vec3 q = cross(s, triangle.edge_ab);
    float v = dot(ray.direction, q) * inverse;
    float t = dot(triangle.edge_ac, q) * inverse;
    if (!(u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > t_min && t <= hit.t)) return false;
    hit = Hit(t, vec2(u, v), index, triangle.id, ray.instance);
    return true;
}

// The 8 bits of each child.
vec4 steps(uint of_children) { return vec4(uvec4(of_children) >> uvec4(0u, 8u, 16u, 24u) & 255u); }

const float MISSED = -1.0;

// Distances at which the ray enters the boxes of a node's children, or MISSED. A second form of enter_box.
vec4 enter_children(WideNode node, vec3 origin, vec3 inverse_direction, float t_min, float t_max) {
    vec3 step = uintBitsToFloat((uvec3(node.exponents) >> uvec3(0u, 8u, 16u) & 255u) << 23u);
    vec4 enter = vec4(t_min);
    vec4 leave = vec4(t_max);
    for (int axis = 0; axis < 3; ++axis) {
        vec4 lower = node.origin[axis] + step[axis] * steps(node.lower[axis]);
        vec4 upper = node.origin[axis] + step[axis] * steps(node.upper[axis]);
        vec4 t0 = (lower - origin[axis]) * inverse_direction[axis];
        vec4 t1 = (upper - origin[axis]) * inverse_direction[axis];
        enter = max(enter, min(t0, t1));
        leave = min(leave, max(t0, t1));
    }
    bvec4 missed = greaterThan(enter, leave * 1.00001);
    return mix(mix(enter, vec4(MISSED), missed), vec4(MISSED), equal(node.children, uvec4(0u)));
}

void put_farther_first(inout vec2 t, inout uvec2 child) {
    if (t.x < t.y) {
        t = t.yx;
        child = child.yx;
    }
}

// Sorting network of five exchanges.
void put_farthest_first(inout vec4 t, inout uvec4 child) {
    put_farther_first(t.xy, child.xy);
    put_farther_first(t.zw, child.zw);
    put_farther_first(t.xz, child.xz);
    put_farther_first(t.yw, child.yw);
    put_farther_first(t.yz, child.yz);
}

// A triangle hit at t in (t_min, t_max), from either side: the nearest one, or with `any` the first one found.
Hit trace(vec3 origin, vec3 direction, float t_min, float t_max, bool any) {
    Hit hit = Hit(t_max, vec2(0.0), NO_TRIANGLE, 0u, 0u);
    LocalRay ray = LocalRay(origin, direction, safe_inverse(direction), 0u);
    uint stack[BVH_STACK_SIZE];  // children to visit: see WideNode. At first the root.
    stack[0] = 0u;
    uint depth = 1u;
    uint outside = 0u;  // children on the stack that are not of the instance that the ray is in
    uint next = 0u;     // of the triangles in the current leaf
    uint end = 0u;
    while (depth > 0u || next < end) {
        // Goes on until a triangle is hit, if it may have a hole there or is as near as the last one, or if any hit will
        // do. What that means is asked outside this loop, because drivers without branches execute all of a loop's code
        // in each iteration.
        Hit found = hit;
        bool stop = false;
        while (!stop && (depth > 0u || next < end)) {
            while (depth > 0u && next == end) {
                uint child = stack[--depth];
                // A loop of at most one iteration, which such drivers leave out where no ray leaves or enters an instance.
                bool enters = (child & 7u) == INSTANCE_CHILD;
                for (bool crosses = enters || depth < outside; crosses; crosses = false) {
                    ray = LocalRay(origin, direction, safe_inverse(direction), 0u);
                    outside = 0u;
                    if (!enters) break;
                    uint instance = child >> 3u;
                    WideNode node = node_at(instance);
                    vec4 rows[3] = mesh_from_world(node);
                    vec3 inside = to_mesh(rows, vec4(direction, 0.0));
                    ray = LocalRay(to_mesh(rows, vec4(origin, 1.0)), inside, safe_inverse(inside), instance);
                    outside = depth;
                    child = node.children.x;
                }
                next = child >> 3u;
                end = next + (child & 7u);
                if (next < end) continue;
                WideNode node = node_at(next);
                vec4 t = enter_children(node, ray.origin, ray.inverse, t_min, hit.t);
                if (!any) put_farthest_first(t, node.children);
                for (int i = 0; i < 4; ++i) {
                    if (t[i] != MISSED) stack[depth++] = node.children[i];
                }
            }
            while (!stop && next < end) {
                if (!intersect_triangle(next++, ray, t_min, found)) continue;
                stop = any || found.t == hit.t || (found.id & TRIANGLE_MASKED) != 0u;
                if (!stop) hit = found;
            }
        }
        bool other = found.triangle != hit.triangle || found.instance != hit.instance;
        if (other && comes_first(found, hit) && !is_hole(triangle_at(found.triangle), found.barycentric)) hit = found;
        if (any && hit.triangle != NO_TRIANGLE) return hit;
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

// Normal of the front where the ray has hit a triangle, of any length; world space.
vec3 front_of(Hit hit) {
    TraceTriangle triangle = triangle_at(hit.triangle);
    return to_world(hit, cross(triangle.edge_ab, triangle.edge_ac));
}

// Whether the ray has hit a surface from a side that reflects.
bool is_surface(Hit hit, vec3 direction) {
    if (hit.triangle == NO_TRIANGLE) return false;
    return is_double_sided(triangle_at(hit.triangle).material) || dot(front_of(hit), direction) < 0.0;
}
