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

}  // namespace

glm::uvec3 PlacedMesh::corners(std::uint32_t i) const {
    const auto& indices = drawn.primitive().indices;
    const glm::uvec3 in_mesh(indices[3 * i], indices[3 * i + 1], indices[3 * i + 2]);
    return mirrored ? glm::uvec3(in_mesh.x, in_mesh.z, in_mesh.y) : in_mesh;
}

Triangle PlacedMesh::triangle(std::uint32_t i) const {
    const glm::uvec3 corner = corners(i);
    return {transformed(matrix, vertices[corner.x].position),
            transformed(matrix, vertices[corner.y].position),
            transformed(matrix, vertices[corner.z].position)};
}

std::vector<Triangle> PlacedMesh::triangles() const {
    std::vector<Triangle> all;
    all.reserve(count());
    for (std::uint32_t i = 0; i < count(); ++i) all.push_back(triangle(i));
    return all;
}

std::array<glm::vec2, 3> PlacedMesh::second_uvs(std::uint32_t i) const {
    const std::vector<glm::vec2>& uvs = drawn.primitive().second_uvs;
    const glm::uvec3 corner = corners(i);
    return {uvs[corner.x], uvs[corner.y], uvs[corner.z]};
}

gpu::TraceTriangle PlacedMesh::traced(std::uint32_t i, std::uint32_t id) const {
    const bool is_masked = drawn.primitive().material->alpha_mode == AlphaMode::mask;
    const Triangle placed = triangle(i);
    const glm::uvec3 corner = corners(i);
    const glm::mat3 turned = normal_matrix(matrix);
    return {.a = placed.a,
            .material = drawn.material,
            .edge_ab = placed.b - placed.a,
            .id = id | (is_masked ? TRIANGLE_MASKED : 0U),
            .edge_ac = placed.c - placed.a,
            .colour_a = packed_colour(vertices[corner.x].colour),
            .uv_a = vertices[corner.x].uv,
            .uv_b = vertices[corner.y].uv,
            .uv_c = vertices[corner.z].uv,
            .colour_b = packed_colour(vertices[corner.y].colour),
            .colour_c = packed_colour(vertices[corner.z].colour),
            .normal_a = packed_normal(turned * vertices[corner.x].normal),
            .normal_b = packed_normal(turned * vertices[corner.y].normal),
            .normal_c = packed_normal(turned * vertices[corner.z].normal)};
}

PlacedMesh placed_in_world(const SceneLayout& layout, const SceneLayout::Drawable& drawable,
                           const ScenePlacement& placement) {
    return {.drawn = *drawable.drawn,
            .vertices = vertices_of(drawable, placement.deformed),
            .matrix = placement.world[drawable.item],
            .mirrored = layout.geometry.items[drawable.item].mirrored};
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

bool is_hole(const PlacedMesh& mesh, std::uint32_t i, glm::vec2 weights) {
    const Material& material = *mesh.drawn.primitive().material;
    if (material.alpha_mode != AlphaMode::mask) return false;
    const gpu::TraceTriangle triangle = mesh.traced(i, 0);
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
