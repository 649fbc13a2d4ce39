// Fragment side of mesh_surface.vert: the surface under the fragment.
#include "bindings.glsl"
#include "scene/materials.glsl"
#include "surfaces/surface.glsl"
#include "types.glsl"

layout(binding = UNIT_BASE_COLOUR) uniform sampler2D base_colour;

in vec3 normal;
in vec2 uv;
in vec4 colour_off_white;  // of the vertices
flat in uint material_index;

// Base colour (linear) and alpha. With MASKED, discards the fragment in a hole of the material's alpha mask. Without it
// there is no discard in the program, so the GPU can reject hidden fragments by an early depth test.
vec4 fragment_colour() {
    vec4 surface = materials[material_index].base_colour * texture(base_colour, uv) * (1.0 + colour_off_white);
#ifdef MASKED
    if (surface.a < materials[material_index].alpha_cutoff) discard;
#endif
    return surface;
}

#ifdef EMISSION

layout(binding = UNIT_EMISSION) uniform sampler2D emission;

// Radiance that the surface emits.
vec3 fragment_emission() { return materials[material_index].emissive * texture(emission, uv).rgb; }

#endif

#ifdef GLOSSY

layout(binding = UNIT_METAL_ROUGHNESS) uniform sampler2D metal_roughness;

PackedGloss fragment_gloss() {
    vec2 stored = texture(metal_roughness, uv).gb;
    Material material = materials[material_index];
    return pack_gloss(material.mirror, stored * vec2(material.roughness, material.metalness));
}

#endif

PackedSurface fragment_surface(vec3 albedo) {
    vec3 facing = gl_FrontFacing ? normal : -normal;
    return pack_surface(albedo, normalize(facing));
}
