// Fragment side of mesh_surface.vert: the surface under the fragment.
#include "bindings.glsl"
#include "surface.glsl"
#include "types.glsl"

layout(std430, binding = BINDING_MATERIALS) readonly restrict buffer Materials { Material materials[]; };
layout(binding = UNIT_BASE_COLOUR) uniform sampler2D base_colour;

in vec3 normal;
in vec2 uv;
flat in uint material_index;

PackedSurface fragment_surface() {
    vec3 albedo = materials[material_index].base_colour.rgb * texture(base_colour, uv).rgb;
    vec3 facing = gl_FrontFacing ? normal : -normal;
    return pack_surface(albedo, normalize(facing));
}
