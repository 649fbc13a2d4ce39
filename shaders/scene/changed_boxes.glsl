// The boxes in which the scene has changed. Passes keep their earlier results for rays that miss all of them.
#include "bindings.glsl"
#include "scene/bvh.glsl"
#include "types.glsl"

// A tree in depth-first order: renderer/passes/scene/changed_boxes.hpp.
layout(std430, binding = BINDING_CHANGED_BOXES) readonly restrict buffer ChangedBoxes { ChangedBox changed_boxes[]; };

uniform bool everything_changed;
uniform uint changed_box_count;  // boxes of the tree

bool is_leaf(uint box) { return changed_boxes[box].next == box + 1u; }

// Whether a ray may hit something else than before, up to t_max.
bool may_have_changed(vec3 origin, vec3 direction, float t_max) {
    if (everything_changed) return true;
    vec3 inverse_direction = safe_inverse(direction);
    uint i = 0u;
    while (i < changed_box_count) {
        ChangedBox box = changed_boxes[i];
        bool enters = !isinf(enter_box(box.lower, box.upper, origin, inverse_direction, 0.0, t_max));
        if (enters && is_leaf(i)) return true;
        i = enters ? i + 1u : box.next;
    }
    return false;
}

// Whether anything may have changed above the plane through `position`.
bool may_have_changed_above(vec3 position, vec3 normal) {
    if (everything_changed) return true;
    uint i = 0u;
    while (i < changed_box_count) {
        ChangedBox box = changed_boxes[i];
        vec3 highest = mix(box.lower, box.upper, greaterThan(normal, vec3(0.0)));
        bool is_above = dot(normal, highest - position) > 0.0;
        if (is_above && is_leaf(i)) return true;
        i = is_above ? i + 1u : box.next;
    }
    return false;
}
