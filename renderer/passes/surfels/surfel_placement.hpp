#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

#include "renderer/gpu/gpu_types.hpp"
#include "renderer/passes/surfels/surfel_focus.hpp"

namespace candela {

/// A point of a triangle.
struct SurfacePoint {
    std::uint32_t triangle = 0;  ///< gpu::TraceTriangle::id
    glm::vec2 weights{0.0F};     ///< of its corners b and c
    bool back = false;           ///< on its back
};

/// Surfels: points on the scene's surfaces that gather light and reflect it. Each represents a cell, the part
/// of the surface around it, which is described by sample points.
struct SurfelSet {
    std::vector<gpu::Surfel> surfels;
    std::vector<gpu::CellPoint> points;  ///< of the cells, in the order of the surfels
    std::vector<std::uint32_t> item_of;  ///< by surfel: index into SceneGeometry::items
    std::vector<SurfacePoint> surfel_places;
    std::vector<SurfacePoint> point_places;
    std::uint32_t emitting_count = 0;  ///< surfels that emit light: the last ones
};

/// The triangles of a scene, on which surfels are placed.
struct SceneTriangles {
    std::vector<gpu::TraceTriangle> triangles;
    std::vector<std::uint32_t> item_of;  ///< by triangle: index into SceneGeometry::items
    std::vector<bool> double_sided;      ///< by material index
    std::vector<bool> emits;             ///< by material index
    /// By item, in the triangles' space. An item without any has the density of a focus everywhere.
    std::vector<std::vector<Focus>> foci{};
};

/// Average number of points of a cell, of surfels that only reflect light and of those that emit it.
inline constexpr std::uint32_t points_a_surfel = 16;
inline constexpr std::uint32_t points_an_emitter = 64;

/// About how many surfels are placed on surfaces that emit light, in addition to `count` on the others. They
/// light the scene directly, so that their number determines how smooth soft shadows are. They have no depth
/// maps, and each pixel traces rays to its share of them: see max_vpls_per_invocation.
[[nodiscard]] constexpr std::uint32_t emitting_surfels(std::uint32_t count) {
    return std::clamp(count / 8, 64U, 128U);
}

/// About how many surfels are placed on surfaces that do not emit light, and on those that do.
struct SurfelCounts {
    std::uint32_t reflecting = 0;
    std::uint32_t emitting = 0;
    bool operator==(const SurfelCounts&) const = default;
};

/// Places surfels on the triangles that reflect light, and likewise on those that emit it, on both sides
/// where the material is double-sided: evenly by area, or as dense as the foci ask for (density_at). Each has
/// a cell of points_a_surfel or points_an_emitter points on average. A cell lies on one side of one item,
/// where the surface is nearly flat; a point that fits no surfel becomes a surfel of its own. The points
/// follow the R2 sequence; the surfels are relaxed by Lloyd's algorithm (1982). Equal arguments give equal
/// results.
[[nodiscard]] SurfelSet place_surfels(const SceneTriangles& scene, const SurfelCounts& counts,
                                      std::uint32_t seed);

}  // namespace candela
