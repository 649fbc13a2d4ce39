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
#ifdef SECOND_UV
in vec2 second_uv;
#endif
in vec4 colour_off_white;  // of the vertices
flat in uint material_index;

// A texel of an image of the material that is MATERIAL_SECOND_UV_*.
#ifdef SECOND_UV
vec4 image_at(sampler2D image, uint which) {
    // Derivatives come from the coordinates themselves: invocations beside the triangle may not see the material.
    mat2 change = mat2(dFdx(uv), dFdy(uv));
    mat2 second_change = mat2(dFdx(second_uv), dFdy(second_uv));
    if (has_second_uv(material_index, which)) return textureGrad(image, second_uv, second_change[0], second_change[1]);
    return textureGrad(image, uv, change[0], change[1]);
}
#else
vec4 image_at(sampler2D image, uint which) { return texture(image, uv); }
#endif

// Base colour (linear) and alpha.
vec4 fragment_colour() {
    return materials[material_index].base_colour * texture(base_colour, uv) * (1.0 + colour_off_white);
}

// With MASKED, discards the fragment in a hole of the material's alpha mask, for which all images must have been read:
// their levels depend on the neighbours, and have no meaning once one of these is gone. Without it there is no discard in
// the program, so the GPU can reject hidden fragments by an early depth test.
void discard_hole(float alpha) {
#ifdef MASKED
    if (alpha < materials[material_index].alpha_cutoff) discard;
#endif
}

#ifdef EMISSION

layout(binding = UNIT_EMISSION) uniform sampler2D emission;

// Radiance that the surface emits.
vec3 fragment_emission() { return materials[material_index].emissive * image_at(emission, MATERIAL_SECOND_UV_EMISSIVE).rgb; }

#endif

#ifdef BUMPY

layout(binding = UNIT_NORMAL_MAP) uniform sampler2D normal_map;
layout(binding = UNIT_OCCLUSION) uniform sampler2D occlusion;

// glTF 2.0, section 3.9.3: a normal in the space of tangent, bitangent and normal.
vec3 mapped_normal(Material material) {
    vec3 stored = 2.0 * image_at(normal_map, MATERIAL_SECOND_UV_NORMAL).xyz - 1.0;
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
    float open = mix(1.0, image_at(occlusion, MATERIAL_SECOND_UV_OCCLUSION).r, material.occlusion_strength);
    return pack_bumps(gl_FrontFacing ? turned : -turned, open);
}

#endif

#ifdef GLOSSY

layout(binding = UNIT_METAL_ROUGHNESS) uniform sampler2D metal_roughness;

PackedGloss fragment_gloss() {
    Material material = materials[material_index];
    vec2 gloss = image_at(metal_roughness, MATERIAL_SECOND_UV_GLOSS).gb * vec2(material.roughness, material.metalness);
#ifdef BUMPY
    gloss.x = widened_roughness(gloss.x, material.normal_scale * image_at(normal_map, MATERIAL_SECOND_UV_NORMAL).a);
#endif
    return pack_gloss(material.mirror, gloss);
}

#endif

PackedSurface fragment_surface(vec3 albedo) {
    vec3 facing = gl_FrontFacing ? normal : -normal;
    return pack_surface(albedo, normalize(facing));
}
