#include "renderer/passes/scene/world_triangles.hpp"

#include <glm/gtc/color_space.hpp>
#include <glm/packing.hpp>

namespace candela {
namespace {

glm::vec3 transformed(const glm::mat4& matrix, glm::vec3 point) {
    return glm::vec3(matrix * glm::vec4(point, 1.0F));
}

/// Rounded to 8 bits, the rgb in sRGB, in which dark colours keep their precision.
std::uint32_t packed_colour(glm::u16vec4 colour) {
    if (colour == glm::u16vec4(65535)) {
        return 0xffffffffU;
    }
    const glm::vec4 linear = glm::vec4(colour) / 65535.0F;
    return glm::packUnorm4x8(glm::vec4(glm::convertLinearToSRGB(glm::vec3(linear)), linear.a));
}

/// Vertex indices of a triangle, counter-clockwise in world space.
glm::uvec3 corners(const SceneLayout& layout, const Origin& origin) {
    const SceneLayout::Drawable& drawable = layout.drawables[origin.drawable];
    const auto& indices = drawable.primitive->indices;
    const std::uint32_t i = origin.first_index;
    if (layout.geometry.items[drawable.item].mirrored) {
        return {indices[i], indices[i + 2], indices[i + 1]};
    }
    return {indices[i], indices[i + 1], indices[i + 2]};
}

}  // namespace

WorldTriangles place_triangles(const SceneLayout& layout, const ScenePlacement& placement) {
    WorldTriangles world;
    for (std::uint32_t d = 0; d < layout.solid_count; ++d) {
        const Primitive& primitive = *layout.drawables[d].primitive;
        const glm::mat4& matrix = placement.world[layout.drawables[d].item];
        for (std::uint32_t i = 0; i < primitive.indices.size(); i += 3) {
            const Origin origin{d, i};
            const glm::uvec3 corner = corners(layout, origin);
            world.triangles.push_back({transformed(matrix, primitive.vertices[corner.x].position),
                                       transformed(matrix, primitive.vertices[corner.y].position),
                                       transformed(matrix, primitive.vertices[corner.z].position)});
            world.origins.push_back(origin);
        }
    }
    return world;
}

std::vector<gpu::TraceTriangle> trace_triangles(const SceneLayout& layout, const WorldTriangles& world,
                                                std::span<const std::uint32_t> order) {
    std::vector<gpu::TraceTriangle> triangles;
    triangles.reserve(order.size());
    for (const std::uint32_t id : order) {
        const Triangle& triangle = world.triangles[id];
        const Origin& origin = world.origins[id];
        const SceneLayout::Drawable& drawable = layout.drawables[origin.drawable];
        const auto& vertices = drawable.primitive->vertices;
        const glm::uvec3 corner = corners(layout, origin);
        triangles.push_back({.a = triangle.a,
                             .material = drawable.material,
                             .edge_ab = triangle.b - triangle.a,
                             .id = origin.drawable < layout.opaque_count ? id : id | TRIANGLE_MASKED,
                             .edge_ac = triangle.c - triangle.a,
                             .colour_a = packed_colour(vertices[corner.x].colour),
                             .uv_a = vertices[corner.x].uv,
                             .uv_b = vertices[corner.y].uv,
                             .uv_c = vertices[corner.z].uv,
                             .colour_b = packed_colour(vertices[corner.y].colour),
                             .colour_c = packed_colour(vertices[corner.z].colour)});
    }
    return triangles;
}

}  // namespace candela
