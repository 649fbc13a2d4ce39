#pragma once

#include <limits>
#include <vector>

#include "tests/reference/geometry.hpp"

namespace candela::reference {

/// A point from which light is reflected.
struct Surface {
    glm::vec3 position;  ///< metres
    glm::vec3 face;      ///< unit normal of the triangle, on the side that is looked at
    glm::vec3 normal;    ///< unit, by which light is weighted
    glm::vec3 albedo;    ///< linear
};

/// A surface that the camera sees.
struct SeenSurface {
    Surface surface;
    float weight;        ///< share of the pixel that shows it
    std::uint32_t part;  ///< of the geometry
};

/// What is seen along a ray, the nearest first: blended surfaces, each in front of what their alpha leaves of
/// those behind, then the solid one. They are shaded by the normals of the mesh.
[[nodiscard]] std::vector<SeenSurface> seen_surfaces(const Geometry& geometry, const Ray& ray);

/// A surface that light bounces off: flat, as its triangle is. The back of a single-sided one is black.
[[nodiscard]] Surface struck_surface(const Geometry& geometry, const Hit& hit, glm::vec3 direction);

/// The ray that leaves the surface on the side that is looked at. It starts above its own triangle, and a
/// little on its way, so that of two walls that meet in a corner neither hides what lies in the corner
/// itself.
[[nodiscard]] inline Ray ray_from(const Surface& surface, glm::vec3 direction, const Geometry& geometry) {
    const float offset = geometry.ray_offset();
    return {.origin = surface.position + offset * surface.face,
            .direction = direction,
            .nearest = offset,
            .farthest = std::numeric_limits<float>::infinity()};
}

}  // namespace candela::reference
