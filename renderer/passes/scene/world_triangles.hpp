#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/bvh/bvh.hpp"
#include "renderer/gpu_types.hpp"
#include "renderer/passes/scene/scene_upload.hpp"

namespace candela {

/// Which triangle of the scene it is.
struct Origin {
    std::uint32_t drawable;     // index into SceneLayout::drawables
    std::uint32_t first_index;  // of its three indices in the primitive
};

/// The triangles that stop light (opaque and masked), in world space, metres.
struct WorldTriangles {
    std::vector<Triangle> triangles;
    std::vector<Origin> origins;  // by triangle
};

/// Transforms the triangles of the solid drawables by their items' matrices in `placement`.
[[nodiscard]] WorldTriangles place_triangles(const SceneLayout& layout, const ScenePlacement& placement);

/// The same triangles in the form that shaders read, in the order of the indices in `order`.
[[nodiscard]] std::vector<gpu::TraceTriangle> trace_triangles(const SceneLayout& layout,
                                                              const WorldTriangles& world,
                                                              std::span<const std::uint32_t> order);

}  // namespace candela
