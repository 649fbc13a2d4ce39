// Shadows of lights. Where the 4 × 4 texels of the shadow map around the receiver agree, the map decides. Elsewhere a
// shadow's edge or a crease may be near, and a ray finds it exactly, however wide a texel is: theory.md, "Edges of
// shadows". Depth is reversed: 1 at the near plane, 0 at infinity (orthographic maps: at their far end). A receiver is
// lit where its depth is greater than or equal to the map's. SHADOW_RAYS: shadows are enabled.
#include "bindings.glsl"
#include "maths.glsl"
#include "scene/bvh.glsl"
#include "surfaces/surface.glsl"
#include "types.glsl"

#ifndef SHADOW_RAYS

float shadow_visibility(uint index, Light light, Surface surface) { return 1.0; }

#else

layout(std430, binding = BINDING_SHADOWS) readonly restrict buffer Shadows { Shadow shadows[]; };
layout(binding = UNIT_SHADOW_CUBES) uniform samplerCubeArrayShadow shadow_cubes;
layout(binding = UNIT_SHADOW_MAPS) uniform sampler2DArrayShadow shadow_maps;

// Metres to lift the receiver along its normal so that its own plane never shadows it in a bilinear look-up:
// texel · (sin θ / √2 + 0.1), θ being the angle between normal and map axis and `texel` a texel's width at the
// receiver. Maps are rendered with a slope-scaled offset of one texel, which covers the rest; 0.1 is a margin for
// rounding. See theory.md, "Lift above shadow maps".
float normal_offset(float texel, float cos_axis) {
    return texel * (0.7072 * sqrt(max(0.0, 1.0 - cos_axis * cos_axis)) + 0.1);
}

// Depth bias, relative, or absolute in orthographic maps, where depth is linear over the map's range. A surface
// perpendicular to the map's axis has no slope and so no offset; if it meets the receiver in a crease, rounding alone
// decides there. This bias, about ten times the rounding error of positions reconstructed from the camera's depth, makes
// the crease lit.
const float crease_bias = 1e-5;

// One texel diagonally away from the receiver.
vec2 diagonal(int i) { return 2.0 * vec2(i & 1, i >> 1) - 1.0; }

// Number of the four look-ups around the receiver that find it lit, fractions included. `from_light`: to the receiver.
float lit_in_cube(Shadow shadow, vec3 from_light, vec3 normal) {
    float depth = largest(from_light);
    vec3 major = mix(vec3(0.0), vec3(1.0), equal(abs(from_light), vec3(depth)));
    float texel = shadow.texel * depth;
    vec3 lifted = from_light + normal * normal_offset(texel, dot(normal, major));
    vec3 across = texel * (major.x > 0.0 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0));
    vec3 up = texel * (major.x + major.y > 0.0 ? vec3(0.0, 0.0, 1.0) : vec3(0.0, 1.0, 0.0));
    float height = min(dot(normal, lifted), -1e-30);
    float lit = 0.0;
    for (int i = 0; i < 4; ++i) {
        vec2 off = diagonal(i);
        vec3 towards = lifted + off.x * across + off.y * up;
        // The receiver's plane is hit at towards · height / (normal · towards).
        float inverse_depth = dot(normal, towards) / (height * largest(towards));
        float reference = clamp(shadow.near_plane * inverse_depth * (1.0 + crease_bias), 0.0, 1.0);
        lit += texture(shadow_cubes, vec4(towards, float(shadow.layer)), reference);
    }
    return lit;
}

vec3 row(mat4 m, int i) { return vec3(m[0][i], m[1][i], m[2][i]); }

// The lifted receiver in the clip space of a flat map, and the depth of its plane around it.
struct FlatReceiver {
    vec3 at;
    vec2 slope;  // change of depth per step in x and y
    float bias;  // of the depth
};

FlatReceiver flat_receiver(Shadow shadow, vec3 position, vec3 normal, vec3 light_position) {
    bool perspective = shadow.kind == SHADOW_PERSPECTIVE;
    vec3 from_light = position - light_position;
    float texel = shadow.texel * (perspective ? dot(from_light, shadow.axis) : 1.0);
    float offset = normal_offset(texel, dot(normal, shadow.axis));
    vec4 clip = shadow.from_world * vec4(position + normal * offset, 1.0);
    vec3 at = clip.xyz / clip.w;
    vec3 x = row(shadow.from_world, 0);
    vec3 y = row(shadow.from_world, 1);
    vec3 z = row(shadow.from_world, 2);
    // The normal's components along x and y of clip space, whose rows are orthogonal: theory.md, "Edges of shadows".
    vec2 across = vec2(dot(normal, x) / dot(x, x), dot(normal, y) / dot(y, y));
    float height = min(dot(normal, from_light) + offset, -1e-30);
    float steepness = perspective ? shadow.near_plane / height : -dot(z, z) / dot(normal, z);
    return FlatReceiver(at, steepness * across, perspective ? at.z * crease_bias : crease_bias);
}

// As lit_in_cube.
float lit_in_map(Shadow shadow, FlatReceiver receiver) {
    float texel = 2.0 / float(textureSize(shadow_maps, 0).x);
    float lit = 0.0;
    for (int i = 0; i < 4; ++i) {
        vec2 off = texel * diagonal(i);
        float reference = clamp(receiver.at.z + dot(receiver.slope, off) + receiver.bias, 0.0, 1.0);
        lit += texture(shadow_maps, vec4((receiver.at.xy + off) * 0.5 + 0.5, float(shadow.layer), reference));
    }
    return lit;
}

// Whether a ray from the surface to the light is blocked. It ends before the light, which may lie on a surface.
bool is_blocked(Shadow shadow, vec3 position, vec3 normal, vec3 light_position) {
    vec3 origin = position + shadow.ray_offset * normal;
    vec3 direction = -shadow.axis;
    float end = 1.0 / 0.0;
    if (shadow.kind != SHADOW_ORTHOGRAPHIC) {
        float distance = max(length(light_position - origin), 1e-30);
        direction = (light_position - origin) / distance;
        end = distance - shadow.ray_offset;
    }
    return any_hit(origin, direction, 0.0, end);
}

// Rays that the invocation may still cast: software drivers stop long loops (see max_vpls_per_invocation in
// renderer/passes/indirect/vpl_light.hpp). Only where the shadows of many lights end does it cast them all.
int shadow_rays_left = MOST_SHADOW_RAYS;

// Share of the light lights[index] that reaches the surface, which must face it, in [0, 1]. It is neither 0 nor 1 only
// where the rays are used up.
float shadow_visibility(uint index, Light light, Surface surface) {
    if (shadows[index].kind == SHADOW_NONE) return 1.0;
    Shadow shadow = shadows[index];
    vec3 position = visible_position(surface, shadow.ray_offset);
    float lit;
    if (shadow.kind == SHADOW_CUBE) {
        lit = lit_in_cube(shadow, position - light.position, face_normal(surface));
    } else {
        lit = lit_in_map(shadow, flat_receiver(shadow, position, face_normal(surface), light.position));
    }
    if (lit == 0.0 || lit == 4.0 || shadow_rays_left == 0) return 0.25 * lit;
    --shadow_rays_left;
    return is_blocked(shadow, position, face_normal(surface), light.position) ? 0.0 : 1.0;
}

#endif
