// Base colour, emission and normal at a ray hit. Images are read from one texel buffer, since a shader cannot select among
// textures by index. They have a reduced resolution, which is enough for diffuse bounces.
#include "bindings.glsl"
#include "maths.glsl"
#include "types.glsl"

layout(std430, binding = BINDING_MATERIALS) readonly restrict buffer Materials { Material materials[]; };
layout(std430, binding = BINDING_TEXELS) readonly restrict buffer Texels { uint texels[]; };  // 8 bits a channel

const uint WRAP_REPEAT = 0u;
const uint WRAP_MIRRORED = 1u;

bool has_second_uv(uint material, uint image) { return (materials[material].flags & image) != 0u; }

bool is_double_sided(uint material) { return (materials[material].flags & MATERIAL_DOUBLE_SIDED) != 0u; }

int wrap(int x, int size, uint mode) {
    if (mode == WRAP_REPEAT) return x - size * int(floor(float(x) / float(size)));
    if (mode == WRAP_MIRRORED) {
        int m = x - 2 * size * int(floor(float(x) / float(2 * size)));
        return m < size ? m : 2 * size - 1 - m;
    }
    return clamp(x, 0, size - 1);
}

// An image in the texel buffer.
struct TexelImage {
    uint first;
    uvec2 size;
    uint wraps;  // of u in the lowest bits, then of v
    bool is_linear;  // else sRGB
};

// Texel at `at`, wrapped; linear, and alpha.
vec4 texel(TexelImage image, ivec2 at) {
    int x = wrap(at.x, int(image.size.x), image.wraps & MATERIAL_WRAP_MASK);
    int y = wrap(at.y, int(image.size.y), (image.wraps >> MATERIAL_WRAP_BITS) & MATERIAL_WRAP_MASK);
    vec4 stored = unpackUnorm4x8(texels[image.first + uint(y) * image.size.x + uint(x)]);
    return image.is_linear ? stored : vec4(srgb_decode(stored.rgb), stored.a);
}

vec4 bilinear_texel(TexelImage image, vec2 uv) {
    vec2 at = uv * vec2(image.size) - 0.5;
    ivec2 corner = ivec2(floor(at));
    vec2 f = at - vec2(corner);
    vec4 top = mix(texel(image, corner), texel(image, corner + ivec2(1, 0)), f.x);
    vec4 bottom = mix(texel(image, corner + ivec2(0, 1)), texel(image, corner + ivec2(1, 1)), f.x);
    return mix(top, bottom, f.y);
}

vec4 colour_at(Material material, vec2 uv) {
    if (material.texel_width == 0u) return material.base_colour;
    TexelImage image = TexelImage(material.first_texel, uvec2(material.texel_width, material.texel_height),
                                  material.flags >> MATERIAL_BASE_COLOUR_WRAP_SHIFT, false);
    return material.base_colour * bilinear_texel(image, uv);
}

// Largest albedo where light is traced. A closed room of it multiplies its light by 1,250; with 1, it would grow without end.
const float MOST_ALBEDO = 0.9992;

// Albedo of the Lambertian surface that stands for a material of this base colour.
vec3 traced_albedo(Material material, vec3 colour) {
    return min(material.traced_share * colour + material.traced_mirror, MOST_ALBEDO);
}

// Radiance that a surface emits.
vec3 emission_at(Material material, vec2 uv) {
    if (material.emissive == vec3(0.0) || material.emissive_width == 0u) return material.emissive;
    uvec2 size = uvec2(material.emissive_width, material.emissive_height);
    TexelImage image =
        TexelImage(material.first_emissive_texel, size, material.flags >> MATERIAL_EMISSIVE_WRAP_SHIFT, false);
    return material.emissive * bilinear_texel(image, uv).rgb;
}

// What a material's normal texture stores, and in alpha how far normals spread: normal_levels.hpp. The material has one.
vec4 stored_normal_at(Material material, vec2 uv) {
    uvec2 size = uvec2(material.normal_width, material.normal_height);
    TexelImage image =
        TexelImage(material.first_normal_texel, size, material.flags >> MATERIAL_NORMAL_WRAP_SHIFT, true);
    return bilinear_texel(image, uv);
}

// Linear colour and alpha of a packed vertex colour.
vec4 vertex_colour(uint colour) {
    vec4 stored = unpackUnorm4x8(colour);
    return vec4(srgb_decode(stored.rgb), stored.a);
}

vec2 hit_uv(TraceTriangle triangle, vec2 barycentric) {
    return triangle.uv_a + barycentric.x * (triangle.uv_b - triangle.uv_a) + barycentric.y * (triangle.uv_c - triangle.uv_a);
}

// The normal of the vertices, interpolated; unit, on the front.
vec3 hit_normal(TraceTriangle triangle, vec2 barycentric) {
    vec3 a = octahedral_decode(unpackSnorm2x16(triangle.normal_a));
    vec3 b = octahedral_decode(unpackSnorm2x16(triangle.normal_b));
    vec3 c = octahedral_decode(unpackSnorm2x16(triangle.normal_c));
    return normalize(a + barycentric.x * (b - a) + barycentric.y * (c - a));
}

vec4 hit_colour(TraceTriangle triangle, vec2 barycentric) {
    vec4 colour = colour_at(materials[triangle.material], hit_uv(triangle, barycentric));
    if ((triangle.colour_a & triangle.colour_b & triangle.colour_c) == 0xffffffffu) return colour;
    vec4 a = vertex_colour(triangle.colour_a);
    vec4 b = vertex_colour(triangle.colour_b);
    vec4 c = vertex_colour(triangle.colour_c);
    return colour * (a + barycentric.x * (b - a) + barycentric.y * (c - a));
}

// Whether there is a hole of the triangle's alpha mask at this point.
bool is_hole(TraceTriangle triangle, vec2 barycentric) {
    if ((triangle.id & TRIANGLE_MASKED) == 0u) return false;
    return hit_colour(triangle, barycentric).a < materials[triangle.material].alpha_cutoff;
}
