// The radiance of the sky. One fragment per pixel without a surface: drawn at depth 0.
#include "bindings.glsl"
#include "sky/sky_direction.glsl"
#include "view/view.glsl"

layout(binding = UNIT_SKY) uniform sampler2D sky_picture;

uniform vec3 radiance_scale;  // multiplies the picture
uniform float rotation;       // radians around +Y

layout(location = 0) out vec4 radiance;

// Interpolated bilinearly; left and right edge of the picture meet.
vec3 sky_radiance(vec3 direction) {
    ivec2 size = textureSize(sky_picture, 0);
    vec2 at = sky_position(direction) * vec2(size) - 0.5;
    ivec2 first = ivec2(floor(at));
    vec2 share = at - vec2(first);
    int left = (first.x + size.x) % size.x;
    int right = (first.x + 1) % size.x;
    int upper = max(first.y, 0);
    int lower = min(first.y + 1, size.y - 1);
    vec3 above = mix(texelFetch(sky_picture, ivec2(left, upper), 0).rgb, texelFetch(sky_picture, ivec2(right, upper), 0).rgb, share.x);
    vec3 below = mix(texelFetch(sky_picture, ivec2(left, lower), 0).rgb, texelFetch(sky_picture, ivec2(right, lower), 0).rgb, share.x);
    return mix(above, below, share.y);
}

// Unit direction that the pixel looks in, world space.
vec3 looking_direction() {
    vec2 ndc = gl_FragCoord.xy / view.target_size * 2.0 - 1.0;
    vec2 aside = view.orthographic != 0u ? vec2(0.0) : (ndc - view.ray_shift) * view.ray_scale;
    return normalize(vec3(aside, -1.0) * mat3(view.view_from_world));
}

void main() {
    radiance = vec4(radiance_scale * sky_radiance(rotate_y(looking_direction(), -rotation)), 0.0);
}
