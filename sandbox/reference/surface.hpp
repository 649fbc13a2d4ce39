#pragma once

#include <vector>

#include "sandbox/reference/constants.hpp"
#include "sandbox/reference/geometry.hpp"

namespace candela::reference {

/// A point from which light is reflected or emitted.
struct Surface {
    glm::vec3 position;  ///< metres
    glm::vec3 face;      ///< unit normal of the triangle, on the side that the ray hit
    glm::vec3 normal;    ///< unit normal that light is weighted with
    glm::vec3 albedo;    ///< linear
    glm::vec3 emission;  ///< radiance that it emits on that side
};

/// A surface that the camera sees.
struct SeenSurface {
    Surface surface;
    float weight;        ///< share of the pixel that shows it
    std::uint32_t part;  ///< of the geometry
};

/// The surfaces seen along a ray, nearest first: blended surfaces, each weighted by the transparency of those
/// in front of it, then the solid one. They are shaded with the normals of the mesh.
[[nodiscard]] std::vector<SeenSurface> seen_surfaces(const Geometry& geometry, const Ray& ray);

/// A surface for bounced light, with the flat normal of its triangle. The back of a single-sided surface is
/// black.
[[nodiscard]] Surface struck_surface(const Geometry& geometry, const Hit& hit, glm::vec3 direction);

/// Whether two surfaces see each other.
[[nodiscard]] bool are_connected(const Geometry& geometry, const Surface& a, const Surface& b);

/// A ray that leaves the surface on the side that was hit. It starts above its own triangle, and a little
/// along its direction, so that where two walls meet in a corner, neither hides points in the corner itself.
[[nodiscard]] inline Ray ray_from(const Surface& surface, glm::vec3 direction, const Geometry& geometry) {
    const float offset = geometry.ray_offset();
    return {.origin = surface.position + offset * surface.face,
            .direction = direction,
            .nearest = offset,
            .farthest = infinity};
}

}  // namespace candela::reference
