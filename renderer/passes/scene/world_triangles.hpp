#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/bvh/bvh.hpp"
#include "renderer/gpu_types.hpp"
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

/// The same triangles in the form that shaders read, in the order of the indices in `order`. Triangle i gets
/// the id `first_id` + i.
[[nodiscard]] std::vector<gpu::TraceTriangle> trace_triangles(
    const SceneLayout& layout, const SceneLayout::Drawable& drawable, std::span<const Vertex> vertices,
    std::span<const Triangle> triangles, std::span<const std::uint32_t> order, std::uint32_t first_id);

}  // namespace candela
