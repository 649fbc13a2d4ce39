// Shadow maps of the lights. Depth is reversed: 1 at the near plane, 0 at infinity, compared with "greater or equal".
#include "bindings.glsl"
#include "types.glsl"

layout(std430, binding = BINDING_SHADOWS) readonly restrict buffer Shadows { Shadow shadows[]; };
layout(binding = UNIT_SHADOW_CUBES) uniform samplerCubeArrayShadow shadow_cubes;
layout(binding = UNIT_SHADOW_MAPS) uniform sampler2DArrayShadow shadow_maps;

// How far to lift the receiver along its normal so that its own plane, as any texel under the bilinear footprint stores
// it, never shades it. From the sample to a texel's centre it is at most a texel in x and one in y, over which the
// plane's depth changes by texel·(|nx| + |ny|), n being the normal in the map's axes. Rendering has pushed the plane away
// by the larger of the two (a slope-scaled offset of one texel, which also keeps the neighbouring surface of a concave
// edge from shading this one); the smaller is at most sin(normal, axis)/√2, and lifting by l gains l in the same
// measure. A tenth of a texel pays for rounding.
float normal_offset(float texel, float cos_axis) {
    return texel * (0.7072 * sqrt(max(0.0, 1.0 - cos_axis * cos_axis)) + 0.1);
}

// A surface that meets the receiver in a crease and lies square to the map's axis has no slope and so no offset: in the
// crease only rounding decides. This share of the depth, some ten times the rounding of positions found from the
// camera's depth, decides for the light.
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

float map_shadow(Shadow shadow, vec3 position, vec3 normal, vec3 light_position) {
    float depth = shadow.kind == SHADOW_PERSPECTIVE ? dot(position - light_position, shadow.axis) : 1.0;
    vec3 lifted = position + normal * normal_offset(shadow.texel * depth, dot(normal, shadow.axis));
    vec4 clip = shadow.from_world * vec4(lifted, 1.0);
    if (clip.w <= 0.0) return 1.0;
    vec3 at = clip.xyz / clip.w;
    // Perspective depth falls off as 1 / distance, orthographic depth is a share of the scene.
    float bias = crease_bias * (shadow.kind == SHADOW_PERSPECTIVE ? at.z : 1.0);
    return texture(shadow_maps, vec4(at.xy * 0.5 + 0.5, float(shadow.layer), clamp(at.z + bias, 0.0, 1.0)));
}

// Share of the light that reaches the position, in [0, 1]. `normal` faces the light.
float shadow_visibility(int index, vec3 position, vec3 normal, vec3 light_position) {
    if (index < 0) return 1.0;
    Shadow shadow = shadows[index];
    if (shadow.kind == SHADOW_CUBE) return cube_shadow(shadow, position, normal, light_position);
    return map_shadow(shadow, position, normal, light_position);
}
