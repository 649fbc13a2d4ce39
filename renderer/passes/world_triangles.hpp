#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/bvh/bvh.hpp"
#include "renderer/gpu_types.hpp"
#include "renderer/passes/scene_upload.hpp"

namespace candela {

/// A triangle's place in the scene.
struct Origin {
    std::uint32_t drawable;
    std::uint32_t first_index;  // of three, in the primitive
};

/// The triangles that stop light, in world space.
struct WorldTriangles {
    std::vector<Triangle> triangles;
    std::vector<Origin> origins;
};

[[nodiscard]] WorldTriangles place_triangles(const SceneLayout& layout, const ScenePlacement& placement);

/// The same for shaders, in this order of indices.
[[nodiscard]] std::vector<gpu::TraceTriangle> trace_triangles(const SceneLayout& layout,
                                                              const WorldTriangles& world,
                                                              std::span<const std::uint32_t> order);

}  // namespace candela
