// The visible surface, and its packed form in the G-buffer. Every shading path packs and unpacks the surface, even
// where it has no G-buffer, so that all of them shade exactly the same values.
#include "maths.glsl"

struct Surface {
    vec3 position;  // world space, metres
    vec3 normal;    // unit, on the side that the viewer sees
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

// `window`: the pixel's centre in window coordinates (pixels), and its window depth.
Surface unpack_surface(PackedSurface surface, vec3 window, vec2 target_size, mat4 world_from_clip) {
    vec4 clip = vec4(window.xy / target_size * 2.0 - 1.0, window.z, 1.0);
    vec4 world = world_from_clip * clip;
    return Surface(world.xyz / world.w, octahedral_decode(surface.normal), surface.albedo);
}
