#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/bvh/box.hpp"
#include "engine/bvh/bvh.hpp"
#include "renderer/gpu/gpu_types.hpp"
#include "renderer/passes/scene/scene_upload.hpp"

namespace candela {

/// Triangle i of a drawable with these vertices, in world space, metres, counter-clockwise from its front.
[[nodiscard]] Triangle place_triangle(const SceneLayout& layout, const SceneLayout::Drawable& drawable,
                                      std::span<const Vertex> vertices, std::uint32_t i,
                                      const glm::mat4& world);
/// All of them.
[[nodiscard]] std::vector<Triangle> place_triangles(const SceneLayout& layout,
                                                    const SceneLayout::Drawable& drawable,
                                                    std::span<const Vertex> vertices, const glm::mat4& world);

/// The box around a placed box, in world space; empty if it is.
[[nodiscard]] Box place_box(const Box& box, const glm::mat4& world);

/// Whether rays need second texture coordinates of the primitive: those of emission or normals.
[[nodiscard]] bool traces_second_uvs(const Primitive& primitive);

/// The second texture coordinates of triangle i, by corner as trace_triangle has them.
[[nodiscard]] std::array<glm::vec2, 3> trace_second_uvs(const SceneLayout& layout,
                                                        const SceneLayout::Drawable& drawable,
                                                        std::uint32_t i);

/// Triangle i in the form that shaders read, with this id.
[[nodiscard]] gpu::TraceTriangle trace_triangle(const SceneLayout& layout,
                                                const SceneLayout::Drawable& drawable,
                                                std::span<const Vertex> vertices, std::uint32_t i,
                                                const glm::mat4& world, std::uint32_t id);

/// Whether there is a hole of the material's alpha mask at a point of a triangle with these weights of its
/// corners b and c.
[[nodiscard]] bool is_hole(const Material& material, const gpu::TraceTriangle& triangle, glm::vec2 weights);

}  // namespace candela
