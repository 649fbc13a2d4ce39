#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/bvh/box.hpp"
#include "engine/bvh/bvh.hpp"
#include "renderer/gpu/gpu_types.hpp"
#include "renderer/passes/scene/scene_layout.hpp"

namespace candela {

/// The triangles of a primitive, in some space. They are counter-clockwise from their fronts there. What it
/// refers to must outlive it.
struct PlacedMesh {
    const DrawnPrimitive& drawn;
    std::span<const Vertex> vertices;  ///< those of its mesh, or deformed ones
    glm::mat4 matrix{1.0F};            ///< leads from the mesh's space to that of the triangles
    bool mirrored = false;             ///< it reverses the winding

    [[nodiscard]] std::uint32_t count() const {
        return static_cast<std::uint32_t>(drawn.primitive().indices.size() / 3);
    }
    /// The indices of the corners of triangle i.
    [[nodiscard]] glm::uvec3 corners(std::uint32_t i) const;
    [[nodiscard]] Triangle triangle(std::uint32_t i) const;
    [[nodiscard]] std::vector<Triangle> triangles() const;
    /// Triangle i in the form that shaders read, with this id.
    [[nodiscard]] gpu::TraceTriangle traced(std::uint32_t i, std::uint32_t id) const;
    /// The second texture coordinates of triangle i, by corner.
    [[nodiscard]] std::array<glm::vec2, 3> second_uvs(std::uint32_t i) const;
};
/// A drawable's triangles, as its item is placed.
[[nodiscard]] PlacedMesh placed_in_world(const SceneLayout& layout, const SceneLayout::Drawable& drawable,
                                         const ScenePlacement& placement);

/// The box around a placed box, in world space; empty if it is.
[[nodiscard]] Box place_box(const Box& box, const glm::mat4& world);

/// Whether rays need second texture coordinates of the primitive: those of emission or normals.
[[nodiscard]] bool traces_second_uvs(const Primitive& primitive);

/// Whether there is a hole of the material's alpha mask at a point of triangle i with these weights of its
/// corners b and c.
[[nodiscard]] bool is_hole(const PlacedMesh& mesh, std::uint32_t i, glm::vec2 weights);

}  // namespace candela
