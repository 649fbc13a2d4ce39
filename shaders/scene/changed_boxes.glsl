// The boxes in which the scene has changed. Passes keep their earlier results for rays that miss all of them.
#include "bindings.glsl"
#include "scene/bvh.glsl"

uniform bool everything_changed;
uniform uint changed_box_count;
uniform vec4 changed_boxes[2 * MOST_CHANGED_BOXES];  // lower and upper corners, metres

// Whether a ray may hit something else than before, up to t_max.
bool may_have_changed(vec3 origin, vec3 direction, float t_max) {
    if (everything_changed) return true;
    vec3 inverse_direction = safe_inverse(direction);
    for (uint i = 0u; i < changed_box_count; ++i) {
        float enter = enter_box(changed_boxes[2u * i].xyz, changed_boxes[2u * i + 1u].xyz, origin, inverse_direction, 0.0, t_max);
        if (!isinf(enter)) return true;
    }
    return false;
}

// Whether anything may have changed above the plane through `position`.
bool may_have_changed_above(vec3 position, vec3 normal) {
    if (everything_changed) return true;
    for (uint i = 0u; i < changed_box_count; ++i) {
        vec3 lower = changed_boxes[2u * i].xyz;
        vec3 upper = changed_boxes[2u * i + 1u].xyz;
        vec3 highest = mix(lower, upper, greaterThan(normal, vec3(0.0)));
        if (dot(normal, highest - position) > 0.0) return true;
    }
    return false;
}
