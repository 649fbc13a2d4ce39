// The radiance of the sky, from its picture.
#include "bindings.glsl"
#include "sky/sky_direction.glsl"

layout(binding = UNIT_SKY) uniform sampler2D sky_picture;

uniform vec3 radiance_scale;  // multiplies the picture
uniform float rotation;       // radians around +Y

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

// Radiance that arrives from a unit direction.
vec3 sky_light(vec3 direction) { return radiance_scale * sky_radiance(rotate_y(direction, -rotation)); }
