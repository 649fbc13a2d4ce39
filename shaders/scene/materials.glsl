// Base colour at a ray hit. Images are read from one texel buffer, since a shader cannot select among textures by
// index. They have a reduced resolution, which is enough for diffuse bounces.
#include "bindings.glsl"
#include "maths.glsl"
#include "types.glsl"

layout(std430, binding = BINDING_MATERIALS) readonly restrict buffer Materials { Material materials[]; };
layout(std430, binding = BINDING_TEXELS) readonly restrict buffer Texels { uint texels[]; };  // sRGB, 8 bits a channel

const uint WRAP_REPEAT = 0u;
const uint WRAP_MIRRORED = 1u;

bool is_double_sided(uint material) { return (materials[material].flags & MATERIAL_DOUBLE_SIDED) != 0u; }

int wrap(int x, int size, uint mode) {
    if (mode == WRAP_REPEAT) return x - size * int(floor(float(x) / float(size)));
    if (mode == WRAP_MIRRORED) {
        int m = x - 2 * size * int(floor(float(x) / float(2 * size)));
        return m < size ? m : 2 * size - 1 - m;
    }
    return clamp(x, 0, size - 1);
}

// Texel at `at`, wrapped as the material says; linear colour and alpha.
vec4 texel(Material material, ivec2 at) {
    int x = wrap(at.x, int(material.texel_width), (material.flags >> MATERIAL_WRAP_U_SHIFT) & MATERIAL_WRAP_MASK);
    int y = wrap(at.y, int(material.texel_height), (material.flags >> MATERIAL_WRAP_V_SHIFT) & MATERIAL_WRAP_MASK);
    vec4 stored = unpackUnorm4x8(texels[material.first_texel + uint(y) * material.texel_width + uint(x)]);
    return vec4(srgb_decode(stored.rgb), stored.a);
}

vec4 bilinear_texel(Material material, vec2 uv) {
    vec2 at = uv * vec2(material.texel_width, material.texel_height) - 0.5;
    ivec2 corner = ivec2(floor(at));
    vec2 f = at - vec2(corner);
    vec4 top = mix(texel(material, corner), texel(material, corner + ivec2(1, 0)), f.x);
    vec4 bottom = mix(texel(material, corner + ivec2(0, 1)), texel(material, corner + ivec2(1, 1)), f.x);
    return mix(top, bottom, f.y);
}

vec4 colour_at(Material material, vec2 uv) {
    if (material.texel_width == 0u) return material.base_colour;
    return material.base_colour * bilinear_texel(material, uv);
}

vec4 hit_colour(TraceTriangle triangle, vec2 barycentric) {
    vec2 uv = triangle.uv_a + barycentric.x * (triangle.uv_b - triangle.uv_a) + barycentric.y * (triangle.uv_c - triangle.uv_a);
    return colour_at(materials[triangle.material], uv);
}

// Whether there is a hole of the triangle's alpha mask at this point.
bool is_hole(TraceTriangle triangle, vec2 barycentric) {
    if (triangle.masked == 0u) return false;
    return hit_colour(triangle, barycentric).a < materials[triangle.material].alpha_cutoff;
}
