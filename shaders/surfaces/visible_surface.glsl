// The visible surface at a pixel, reconstructed from the depth and normal textures.
#include "bindings.glsl"
#include "surfaces/surface.glsl"
#include "view/view.glsl"

layout(binding = UNIT_NORMAL) uniform sampler2D surface_normal;
layout(binding = UNIT_DEPTH) uniform sampler2D surface_depth;

// `depth`: the pixel's window depth; above 0, as 0 means that there is no surface.
Surface visible_surface(ivec2 at, float depth, vec3 albedo) {
    PackedSurface stored = PackedSurface(albedo, texelFetch(surface_normal, at, 0).rg);
    return unpack_surface(stored, vec3(vec2(at) + 0.5, depth), view.target_size, view.world_from_clip);
}
