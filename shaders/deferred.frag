#include "bindings.glsl"
#include "light_list_all.glsl"
#include "lighting.glsl"

uniform mat4 world_from_clip;
uniform vec2 target_size;

layout(binding = UNIT_ALBEDO) uniform sampler2D gbuffer_albedo;
layout(binding = UNIT_NORMAL) uniform sampler2D gbuffer_normal;
layout(binding = UNIT_DEPTH) uniform sampler2D gbuffer_depth;

layout(location = 0) out vec4 radiance;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float depth = texelFetch(gbuffer_depth, pixel, 0).r;
    if (depth == 0.0) discard;
    PackedSurface stored = PackedSurface(texelFetch(gbuffer_albedo, pixel, 0).rgb, texelFetch(gbuffer_normal, pixel, 0).rg);
    Surface surface = unpack_surface(stored, vec3(gl_FragCoord.xy, depth), target_size, world_from_clip);
    radiance = vec4(reflected_radiance(surface), 1.0);
}
