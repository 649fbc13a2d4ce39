// Fragment side of mesh_surface.vert: the surface under the fragment.
#include "bindings.glsl"
#include "scene/materials.glsl"
#include "surfaces/surface.glsl"
#include "types.glsl"

layout(binding = UNIT_BASE_COLOUR) uniform sampler2D base_colour;

in vec3 normal;
#ifdef BUMPY
in vec4 tangent;  // as Vertex::tangent, world space
#endif
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

#ifdef BUMPY

layout(binding = UNIT_NORMAL_MAP) uniform sampler2D normal_map;
layout(binding = UNIT_OCCLUSION) uniform sampler2D occlusion;

// glTF 2.0, section 3.9.3: a normal in the space of tangent, bitangent and normal.
vec3 mapped_normal(Material material) {
    vec3 stored = 2.0 * texture(normal_map, uv).xyz - 1.0;
    vec3 across = normalize(normal);
    vec2 aside = material.normal_scale * stored.xy;
    // Images have no exact zero, so that surfaces without one must not read it.
    if (material.normal_scale == 0.0) return across;
    vec3 along = normalize(tangent.xyz);
    return normalize(aside.x * along + aside.y * tangent.w * cross(across, along) + stored.z * across);
}

PackedBumps fragment_bumps() {
    Material material = materials[material_index];
    vec3 turned = mapped_normal(material);
    float open = mix(1.0, texture(occlusion, uv).r, material.occlusion_strength);
    return pack_bumps(gl_FrontFacing ? turned : -turned, open);
}

#endif

#ifdef GLOSSY

layout(binding = UNIT_METAL_ROUGHNESS) uniform sampler2D metal_roughness;

PackedGloss fragment_gloss() {
    Material material = materials[material_index];
    vec2 gloss = texture(metal_roughness, uv).gb * vec2(material.roughness, material.metalness);
#ifdef BUMPY
    gloss.x = widened_roughness(gloss.x, material.normal_scale * texture(normal_map, uv).a);
#endif
    return pack_gloss(material.mirror, gloss);
}

#endif

PackedSurface fragment_surface(vec3 albedo) {
    vec3 facing = gl_FrontFacing ? normal : -normal;
    return pack_surface(albedo, normalize(facing));
}
