#pragma once

#include <optional>
#include <vector>

#include "renderer/tools/reference/bsdf.hpp"
#include "renderer/tools/reference/constants.hpp"
#include "renderer/tools/reference/geometry.hpp"

namespace candela::reference {

/// A point from which light is reflected or emitted.
struct Surface {
    glm::vec3 position;          ///< metres
    glm::vec3 face;              ///< unit normal of the triangle, on the side that the ray hit
    glm::vec3 normal;            ///< unit normal that light is weighted with
    glm::vec3 albedo;            ///< linear; 1 if it is glossy
    glm::vec3 emission;          ///< radiance that it emits on that side
    std::optional<Bsdf> bsdf{};  ///< of a glossy surface; Lambertian if not set
    /// Whether it shows other surfaces as they are. Otherwise it sees Lambertian ones of equal albedo in
    /// place of glossy ones: see Settings::caustics.
    bool shows_gloss = true;
};

/// A surface that the camera sees.
struct SeenSurface {
    Surface surface;
    glm::vec3 weight;    ///< share of the pixel that shows it
    glm::vec3 through;   ///< share of the light from behind that the surface lets through
    std::uint32_t part;  ///< of the geometry
    float openness;      ///< share of the light from emitters, the sky and other surfaces that reaches it
};

/// The surfaces seen along a ray, nearest first: blended surfaces and glass, each weighted by what those in
/// front of it let through, then the solid one. They are shaded with the normals of the mesh, turned by
/// normal textures.
[[nodiscard]] std::vector<SeenSurface> seen_surfaces(const Geometry& geometry, const Ray& ray);

/// A surface for bounced light that a ray from the viewer has hit, with the flat normal of its triangle:
/// normal and occlusion textures do not count. The back of a single-sided surface is black. If not
/// `as_it_is`, it is Lambertian, of equal albedo.
[[nodiscard]] Surface struck_surface(const Geometry& geometry, const Hit& hit, glm::vec3 direction,
                                     bool as_it_is = true);

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
