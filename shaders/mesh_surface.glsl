// Fragment side of mesh_surface.vert: the surface under the fragment.
#include "bindings.glsl"
#include "materials.glsl"
#include "surface.glsl"
#include "types.glsl"

layout(binding = UNIT_BASE_COLOUR) uniform sampler2D base_colour;

in vec3 normal;
in vec2 uv;
flat in uint material_index;

// Base colour, linear, with its alpha. Drops the fragment if it lies in a hole of the material's mask.
vec4 fragment_colour() {
    vec4 colour = materials[material_index].base_colour * texture(base_colour, uv);
    if (colour.a < materials[material_index].alpha_cutoff) discard;
    return colour;
}

// Share of what lies behind that the surface covers.
float fragment_cover(vec4 colour) {
    return (materials[material_index].flags & MATERIAL_BLENDED) != 0u ? colour.a : 1.0;
}

PackedSurface fragment_surface(vec3 albedo) {
    vec3 facing = gl_FrontFacing ? normal : -normal;
    return pack_surface(albedo, normalize(facing));
}
