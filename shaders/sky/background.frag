// The radiance of the sky. One fragment per pixel without a surface: drawn at depth 0.
#include "bindings.glsl"
#include "sky/sky_picture.glsl"
#include "view/view.glsl"

layout(location = 0) out vec4 radiance;

// Unit direction that the pixel looks in, world space.
vec3 looking_direction() {
    vec2 ndc = gl_FragCoord.xy / view.target_size * 2.0 - 1.0;
    vec2 aside = view.orthographic != 0u ? vec2(0.0) : (ndc - view.ray_shift) * view.ray_scale;
    return normalize(vec3(aside, -1.0) * mat3(view.view_from_world));
}

void main() {
    radiance = vec4(sky_light(looking_direction()), 0.0);
}
