#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "renderer/tools/reference/sampling.hpp"
#include "renderer/tools/reference/surface.hpp"

namespace candela::reference {

// Where light that a surface reflects is looked for, and how much of it is reflected. Lambertian surfaces
// look in cosine-distributed directions, glossy ones as Bsdf says.

/// A way that light may take to a surface. The quotient is the share of the light that is reflected, divided
/// by the surface's albedo: 1 for Lambertian surfaces.
struct Scattering {
    float density;        ///< with which the surface looks along that way
    glm::vec3 reflected;  ///< the radiance that it reflects, divided by its albedo, of unit radiance
};

/// From a unit vector: per solid angle (1/sr). Zero if it points below the surface's normal.
[[nodiscard]] Scattering scattering(const Surface& surface, glm::vec3 towards);

/// From another surface: per area of it (1/m²).
[[nodiscard]] Scattering scattering(const Surface& surface, const Surface& from);

/// A unit vector in which the surface looks; it may point below the surface. Both components of `u` are in
/// [0, 1).
[[nodiscard]] glm::vec3 look_around(const Surface& surface, glm::vec2 u, Sampler& sampler);

}  // namespace candela::reference
