#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "renderer/passes/scene/scene_layout.hpp"
#include "renderer/passes/surfels/scene_surfaces.hpp"

namespace candela {

/// A primitive as a layout has it.
inline std::shared_ptr<const DrawnPrimitive> drawn_primitive(const std::shared_ptr<const Mesh>& mesh,
                                                             std::uint32_t index) {
    DrawnPrimitive drawn{.mesh = mesh, .index_in_mesh = index};
    for (const Vertex& vertex : drawn.primitive().vertices) drawn.bounds.grow(vertex.position);
    return std::make_shared<const DrawnPrimitive>(std::move(drawn));
}

/// Adds an item of a mesh to a layout, with what rays and surfels need of it: no draw commands. Items of one
/// mesh that follow each other share its primitives.
inline void add_item(SceneLayout& layout, const std::shared_ptr<const Mesh>& mesh, bool mirrored = false) {
    const auto item = static_cast<std::uint32_t>(layout.geometry.items.size());
    const auto first = static_cast<std::uint32_t>(layout.drawables.size());
    const auto count = static_cast<std::uint32_t>(mesh->primitives.size());
    const bool is_shared = item > 0 && layout.geometry.items[item - 1].mesh == mesh;
    const Entity entity{item, 0};
    layout.geometry.items.push_back({.entity = entity, .mesh = mesh, .mirrored = mirrored});
    layout.first_of_item.push_back(first);
    for (std::uint32_t i = 0; i < count; ++i) {
        layout.drawables.push_back(
            {.entity = entity,
             .item = item,
             .next = i + 1 == count ? SceneLayout::none : first + i + 1,
             .drawn = is_shared ? layout.drawables[first - count + i].drawn : drawn_primitive(mesh, i)});
    }
}

/// The surfaces of items, one for each mesh, in their own space.
inline SceneSurfaces surfaces_of(const std::vector<std::shared_ptr<const Mesh>>& meshes) {
    SceneLayout layout;
    for (const auto& mesh : meshes) add_item(layout, mesh);
    return {layout, std::vector<glm::mat3>(meshes.size(), glm::mat3(1.0F))};
}

/// A parallelogram of two triangles that faces cross(u, v). Its texture covers it once, along u and v.
inline std::shared_ptr<const Mesh> parallelogram(glm::vec3 corner, glm::vec3 u, glm::vec3 v,
                                                 std::shared_ptr<const Material> material) {
    Primitive primitive{.vertices = {}, .indices = {0, 1, 2, 3, 2, 1}, .material = std::move(material)};
    for (const glm::vec2 at : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(0, 1), glm::vec2(1, 1)}) {
        primitive.vertices.push_back(
            {.position = corner + at.x * u + at.y * v, .normal = glm::normalize(glm::cross(u, v)), .uv = at});
    }
    Mesh mesh;
    mesh.primitives.push_back(std::move(primitive));
    return std::make_shared<const Mesh>(std::move(mesh));
}

}  // namespace candela
