// The visible surface, and its packed form in the G-buffer. Every path goes through the packed form, so that all of
// them shade the very same numbers.
#include "maths.glsl"

struct Surface {
    vec3 position;  // world space, metres
    vec3 normal;    // unit, towards the viewer's side
    vec3 albedo;    // linear
};

struct PackedSurface {
    vec3 albedo;  // already rounded to half floats
    vec2 normal;  // octahedral
};

PackedSurface pack_surface(vec3 albedo, vec3 normal) {
    vec3 rounded = vec3(unpackHalf2x16(packHalf2x16(albedo.rg)), unpackHalf2x16(packHalf2x16(albedo.bb)).x);
    return PackedSurface(rounded, octahedral_encode(normal));
}

// `window` is the pixel's centre in window coordinates and its depth.
Surface unpack_surface(PackedSurface surface, vec3 window, vec2 target_size, mat4 world_from_clip) {
    vec4 clip = vec4(window.xy / target_size * 2.0 - 1.0, window.z, 1.0);
    vec4 world = world_from_clip * clip;
    return Surface(world.xyz / world.w, octahedral_decode(surface.normal), surface.albedo);
}
