// Writes surfaces that the host has drawn to the G-buffer. One fragment per pixel. HostSurfaces describes the textures.
#include "bindings.glsl"
#include "maths.glsl"
#include "view/view.glsl"

layout(binding = UNIT_ALBEDO) uniform sampler2D host_albedo;
layout(binding = UNIT_NORMAL) uniform sampler2D host_normal;
layout(binding = UNIT_DEPTH) uniform sampler2D host_depth;
#ifdef GLOSSY
layout(binding = UNIT_GLOSS) uniform sampler2D host_material;
#endif

uniform mat4 view_from_host_clip;
uniform bool clip_depth_from_0;
uniform float empty_depth;
uniform uint normal_encoding;    // see NormalEncoding
uniform mat3 world_from_normal;

layout(location = 0) out vec2 packed_normal;
layout(location = 1) out vec4 albedo;
#ifdef GLOSSY
layout(location = 2) out vec4 mirror;
layout(location = 3) out vec2 gloss;
#endif

vec3 decoded_normal(vec3 stored) {
    if (normal_encoding == 2u) return octahedral_decode(stored.xy);
    return normalize(normal_encoding == 1u ? stored * 2.0 - 1.0 : stored);
}

// Window depth in this view of a surface whose view-space z is `z`.
float window_depth(float z) {
    return view.orthographic != 0u ? view.depth_terms.x * z + view.depth_terms.y
                                   : -view.depth_terms.x - view.depth_terms.y / z;
}

void main() {
    vec2 share = gl_FragCoord.xy / view.target_size;
    ivec2 at = ivec2(share * vec2(textureSize(host_depth, 0)));
    float depth = texelFetch(host_depth, at, 0).r;
    if (depth == empty_depth) discard;
    vec4 on_view = view_from_host_clip * vec4(share * 2.0 - 1.0, clip_depth_from_0 ? depth : depth * 2.0 - 1.0, 1.0);
    gl_FragDepth = window_depth(on_view.z / on_view.w);
    albedo = vec4(texelFetch(host_albedo, at, 0).rgb, 1.0);
    packed_normal = octahedral_encode(world_from_normal * decoded_normal(texelFetch(host_normal, at, 0).xyz));
#ifdef GLOSSY
    mirror = vec4(vec3(0.04), 1.0);  // of an interface of index of refraction 1.5, by Fresnel
    gloss = texelFetch(host_material, at, 0).rg;
#endif
}
