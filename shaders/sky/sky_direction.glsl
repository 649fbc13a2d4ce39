// Directions in an equirectangular picture, as in engine/scene/sky.cpp: the top row is +Y, the centre is -Z, and +X lies
// a quarter of the width to the right of it.
#include "maths.glsl"

// Position in the picture, from the top left corner (0, 0) to (1, 1), of a unit direction.
vec2 sky_position(vec3 direction) {
    float azimuth = atan(direction.x, -direction.z);
    return vec2(azimuth / (2.0 * PI) + 0.5, acos(clamp(direction.y, -1.0, 1.0)) / PI);
}

vec3 sky_direction(vec2 at) {
    float azimuth = 2.0 * PI * (at.x - 0.5);
    float polar = PI * at.y;
    return vec3(sin(azimuth) * sin(polar), cos(polar), -cos(azimuth) * sin(polar));
}

// Rotated around +Y, from +Z towards +X; radians.
vec3 rotate_y(vec3 v, float angle) {
    float c = cos(angle);
    float s = sin(angle);
    return vec3(c * v.x + s * v.z, v.y, c * v.z - s * v.x);
}
