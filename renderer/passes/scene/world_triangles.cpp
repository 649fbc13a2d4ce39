#include "renderer/passes/scene/world_triangles.hpp"

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/color_space.hpp>
#include <glm/matrix.hpp>
#include <glm/packing.hpp>

#include "renderer/passes/scene/image_texel.hpp"

namespace candela {
namespace {

glm::vec3 transformed(const glm::mat4& matrix, glm::vec3 point) {
    return glm::vec3(matrix * glm::vec4(point, 1.0F));
}

/// Rounded to 8 bits, the rgb in sRGB, in which dark colours keep their precision.
std::uint32_t packed_colour(glm::u16vec4 colour) {
    if (colour == glm::u16vec4(65535)) return 0xffffffffU;
    const glm::vec4 linear = glm::vec4(colour) / 65535.0F;
    return glm::packUnorm4x8(glm::vec4(glm::convertLinearToSRGB(glm::vec3(linear)), linear.a));
}

/// As world_normal of shaders/surfaces/mesh.glsl.
glm::mat3 normal_matrix(const glm::mat4& world) {
    const glm::mat3 m(world);
    const glm::mat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
    return glm::determinant(m) < 0.0F ? -cofactors : cofactors;
}

/// Octahedral encoding (Cigolle et al., "A Survey of Efficient Representations for Independent Unit Vectors",
/// 2014) of a vector of any length, rounded to 16 bits. Of 0, that of +Z.
std::uint32_t packed_normal(const glm::vec3& normal) {
    const float sum = std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z);
    if (!(sum > 0.0F)) return 0;
    const glm::vec2 p = glm::vec2(normal) / sum;
    const glm::vec2 folded((p.x >= 0.0F ? 1.0F : -1.0F) * (1.0F - std::abs(p.y)),
                           (p.y >= 0.0F ? 1.0F : -1.0F) * (1.0F - std::abs(p.x)));
    return glm::packSnorm2x16(normal.z >= 0.0F ? p : folded);
}

/// Vertex indices of triangle i of a drawable, counter-clockwise in world space.
glm::uvec3 corners(const SceneLayout& layout, const SceneLayout::Drawable& drawable, std::uint32_t i) {
    const auto& indices = drawable.primitive().indices;
    const std::uint32_t first = 3 * i;
    if (layout.geometry.items[drawable.item].mirrored) {
        return {indices[first], indices[first + 2], indices[first + 1]};
    }
    return {indices[first], indices[first + 1], indices[first + 2]};
}

}  // namespace

Triangle place_triangle(const SceneLayout& layout, const SceneLayout::Drawable& drawable,
                        std::span<const Vertex> vertices, std::uint32_t i, const glm::mat4& world) {
    const glm::uvec3 corner = corners(layout, drawable, i);
    return {transformed(world, vertices[corner.x].position), transformed(world, vertices[corner.y].position),
            transformed(world, vertices[corner.z].position)};
}

std::vector<Triangle> place_triangles(const SceneLayout& layout, const SceneLayout::Drawable& drawable,
                                      std::span<const Vertex> vertices, const glm::mat4& world) {
    const auto count = static_cast<std::uint32_t>(drawable.primitive().indices.size() / 3);
    std::vector<Triangle> triangles;
    triangles.reserve(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        triangles.push_back(place_triangle(layout, drawable, vertices, i, world));
    }
    return triangles;
}

Box place_box(const Box& box, const glm::mat4& world) {
    Box around;
    for (unsigned i = 0; i < 8; ++i) {
        around.grow(transformed(world, box.corner(i)));
    }
    return around;
}

bool traces_second_uvs(const Primitive& primitive) {
    const Material& material = *primitive.material;
    return (material.second_uvs.emissive && material.emissive_texture) ||
           (material.second_uvs.normal && material.normal_texture);
}

std::array<glm::vec2, 3> trace_second_uvs(const SceneLayout& layout, const SceneLayout::Drawable& drawable,
                                          std::uint32_t i) {
    const std::vector<glm::vec2>& uvs = drawable.primitive().second_uvs;
    const glm::uvec3 corner = corners(layout, drawable, i);
    return {uvs[corner.x], uvs[corner.y], uvs[corner.z]};
}

gpu::TraceTriangle trace_triangle(const SceneLayout& layout, const SceneLayout::Drawable& drawable,
                                  std::span<const Vertex> vertices, std::uint32_t i, const glm::mat4& world,
                                  std::uint32_t id) {
    const bool is_masked = drawable.primitive().material->alpha_mode == AlphaMode::mask;
    const Triangle triangle = place_triangle(layout, drawable, vertices, i, world);
    const glm::uvec3 corner = corners(layout, drawable, i);
    const glm::mat3 to_world = normal_matrix(world);
    return {.a = triangle.a,
            .material = drawable.drawn->material,
            .edge_ab = triangle.b - triangle.a,
            .id = id | (is_masked ? TRIANGLE_MASKED : 0U),
            .edge_ac = triangle.c - triangle.a,
            .colour_a = packed_colour(vertices[corner.x].colour),
            .uv_a = vertices[corner.x].uv,
            .uv_b = vertices[corner.y].uv,
            .uv_c = vertices[corner.z].uv,
            .colour_b = packed_colour(vertices[corner.y].colour),
            .colour_c = packed_colour(vertices[corner.z].colour),
            .normal_a = packed_normal(to_world * vertices[corner.x].normal),
            .normal_b = packed_normal(to_world * vertices[corner.y].normal),
            .normal_c = packed_normal(to_world * vertices[corner.z].normal)};
}

bool is_hole(const Material& material, const gpu::TraceTriangle& triangle, glm::vec2 weights) {
    if (material.alpha_mode != AlphaMode::mask) return false;
    const auto interpolated = [&](const auto& a, const auto& b, const auto& c) {
        return a + weights.x * (b - a) + weights.y * (c - a);
    };
    const auto alpha_of = [](std::uint32_t colour) { return static_cast<float>(colour >> 24U) / 255.0F; };
    const Image* const image = material.base_colour_texture.get();
    const glm::vec2 uv = interpolated(triangle.uv_a, triangle.uv_b, triangle.uv_c);
    const float of_vertices =
        interpolated(alpha_of(triangle.colour_a), alpha_of(triangle.colour_b), alpha_of(triangle.colour_c));
    const float of_image = image == nullptr ? 1.0F : alpha_at(*image, uv);
    return of_vertices * material.base_colour.a * of_image < material.alpha_cutoff;
}

}  // namespace candela
