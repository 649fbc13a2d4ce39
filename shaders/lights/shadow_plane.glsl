// What a texel of a shadow map stores, for those who draw the maps and those who look them up.

// Texels along each axis from the centre of one that a triangle is drawn into. One, and a margin for the rounding of
// vertices in clip space.
#define SHADOW_REACH 1.01

// The depth, and in its lowest bit whether the triangle covers all texels within reach. That bit is lost at depth 1, the
// near plane.
float shadow_depth(float depth, bool covers) {
    return uintBitsToFloat((floatBitsToUint(depth) & ~1u) | (covers ? 1u : 0u));
}
bvec4 covers_all(vec4 stored) { return notEqual(floatBitsToUint(stored) & 1u, uvec4(0u)); }

vec3 row(mat3 m, int i) { return vec3(m[0][i], m[1][i], m[2][i]); }
vec3 row(mat4 m, int i) { return vec3(m[0][i], m[1][i], m[2][i]); }

// Change of a plane's depth per step in x and y of the map's clip space: README.md, "Shadow maps". `height`: of a point of
// the plane above the light, along the normal. `from_world`, `depth_scale`: see Shadow.
vec2 plane_slope(mat4 from_world, float depth_scale, vec3 normal, float height) {
    vec3 x = row(from_world, 0);
    vec3 y = row(from_world, 1);
    vec3 z = row(from_world, 2);
    float steepness = depth_scale > 0.0 ? depth_scale / height : -dot(z, z) / dot(normal, z);
    return steepness * vec2(dot(normal, x) / dot(x, x), dot(normal, y) / dot(y, y));
}
