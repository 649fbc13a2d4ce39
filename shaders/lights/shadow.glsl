// Look-up in the shadow maps of lights. Depth is reversed: 1 at the near plane, 0 at infinity (orthographic maps: at
// their far end). A receiver is lit where its depth is greater than or equal to the map's. SUN_RAYS: the scene has
// directional lights with shadows.
#include "bindings.glsl"
#include "scene/bvh.glsl"
#include "types.glsl"

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

// Relative depth bias. A surface perpendicular to the map's axis has no slope and so no offset; if it meets the
// receiver in a crease, rounding alone decides there. This bias, about ten times the rounding error of positions
// reconstructed from the camera's depth, makes the crease lit.
const float crease_bias = 1e-5;

float largest(vec3 v) { return max(abs(v.x), max(abs(v.y), abs(v.z))); }

float cube_shadow(Shadow shadow, vec3 position, vec3 normal, vec3 light_position) {
    vec3 from_light = position - light_position;
    float depth = largest(from_light);
    vec3 major = mix(vec3(0.0), vec3(1.0), equal(abs(from_light), vec3(depth)));
    vec3 lifted = from_light + normal * normal_offset(shadow.texel * depth, dot(normal, major));
    float reference = min(shadow.near_plane / largest(lifted) * (1.0 + crease_bias), 1.0);
    return texture(shadow_cubes, vec4(lifted, float(shadow.layer)), reference);
}

float spot_shadow(Shadow shadow, vec3 position, vec3 normal, vec3 light_position) {
    float depth = dot(position - light_position, shadow.axis);
    vec3 lifted = position + normal * normal_offset(shadow.texel * depth, dot(normal, shadow.axis));
    vec4 clip = shadow.from_world * vec4(lifted, 1.0);
    if (clip.w <= 0.0) return 1.0;
    vec3 at = clip.xyz / clip.w;
    float reference = clamp(at.z * (1.0 + crease_bias), 0.0, 1.0);
    return texture(shadow_maps, vec4(at.xy * 0.5 + 0.5, float(shadow.layer), reference));
}

#ifdef SUN_RAYS

vec3 row(mat4 m, int i) { return vec3(m[0][i], m[1][i], m[2][i]); }

// Change of depth on the receiver's plane per step in x and y, in the map's clip space. The rows of the matrix are
// orthogonal.
vec2 receiver_slope(mat4 from_world, vec3 normal) {
    vec3 x = row(from_world, 0);
    vec3 y = row(from_world, 1);
    vec3 z = row(from_world, 2);
    return -vec2(dot(normal, x) / dot(x, x), dot(normal, y) / dot(y, y)) * dot(z, z) / dot(normal, z);
}

// Where the 4 × 4 texels around the receiver agree, the map decides. Elsewhere a shadow's edge may be near, and a ray
// finds it exactly, however close the camera is.
float sun_shadow(Shadow shadow, vec3 position, vec3 normal) {
    vec3 lifted = position + normal * normal_offset(shadow.texel, dot(normal, shadow.axis));
    vec3 at = (shadow.from_world * vec4(lifted, 1.0)).xyz;
    vec2 slope = receiver_slope(shadow.from_world, normal);
    float texel = 2.0 / float(textureSize(shadow_maps, 0).x);
    float lit = 0.0;
    for (int i = 0; i < 4; ++i) {
        vec2 off = texel * (2.0 * vec2(i & 1, i >> 1) - 1.0);
        // Depth is linear over the map's range, so the bias is absolute.
        float reference = clamp(at.z + dot(slope, off) + crease_bias, 0.0, 1.0);
        lit += texture(shadow_maps, vec4((at.xy + off) * 0.5 + 0.5, float(shadow.layer), reference));
    }
    if (lit == 0.0 || lit == 4.0) return 0.25 * lit;
    return any_hit(position + shadow.ray_offset * normal, -shadow.axis, 0.0, 1.0 / 0.0) ? 0.0 : 1.0;
}

#endif

// Share of the light that reaches the position, in [0, 1]. `normal` must face the light.
float shadow_visibility(int index, vec3 position, vec3 normal, vec3 light_position) {
    if (index < 0) return 1.0;
    Shadow shadow = shadows[index];
    if (shadow.kind == SHADOW_CUBE) return cube_shadow(shadow, position, normal, light_position);
#ifdef SUN_RAYS
    if (shadow.kind == SHADOW_ORTHOGRAPHIC) return sun_shadow(shadow, position, normal);
#endif
    return spot_shadow(shadow, position, normal, light_position);
}
