// The visible surface at a pixel, reconstructed from the depth and normal textures. With MIRRORED, that which a glossy
// surface shows there.
#include "bindings.glsl"
#include "surfaces/surface.glsl"
#include "view/view.glsl"

layout(binding = UNIT_NORMAL) uniform sampler2D surface_normal;
layout(binding = UNIT_DEPTH) uniform sampler2D surface_depth;

// Face normal of the surface at a pixel.
vec3 visible_face_normal(ivec2 at) { return octahedral_decode(texelFetch(surface_normal, at, 0).rg); }

#ifdef MIRRORED

// What a glossy surface shows at the pixel, as mirror_rays.frag has found it. `depth` is the width of a pixel there in
// metres. 0 means that there is no surface.
Surface visible_surface(ivec2 at, float depth, vec3 albedo) {
    vec4 stored = texelFetch(surface_normal, at, 0);
    Surface surface;
    surface.position = texelFetch(surface_depth, at, 0).gba;
    surface.normal = octahedral_decode(stored.rg);
    surface.albedo = albedo;
    surface.to_viewer = octahedral_decode(stored.ba);
    surface.pixel = depth;
    return surface;
}

#else

// `depth`: the pixel's window depth. 0 means that there is no surface; the result is then a surface at the near plane,
// whose light is to be discarded. Depth 0 itself is at infinity, from where a ray would visit every node of the BVH: more
// than software drivers allow, which then stop all loops of the neighbouring invocations, too.
Surface visible_surface(ivec2 at, float depth, vec3 albedo) {
    PackedSurface stored = PackedSurface(albedo, texelFetch(surface_normal, at, 0).rg);
    vec3 window = vec3(vec2(at) + 0.5, depth > 0.0 ? depth : 1.0);
    return unpack_surface(stored, window, view.target_size, view.world_from_clip);
}

#endif
