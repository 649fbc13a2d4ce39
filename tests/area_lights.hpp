#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace candela {

// Irradiance from uniform Lambertian emitters without occlusion, in closed form.

/// From a planar polygon of unit radiance that lies wholly above the receiver's plane; its corners are
/// clockwise as seen from the receiver at `at` with the unit normal `normal`. Lambert, "Photometria" (1760):
/// half the sum over the edges of the angle that they subtend times the cosine between the receiver's normal
/// and that of the plane through the edge and the receiver.
template <std::size_t corners>
double irradiance_of_polygon(const std::array<glm::dvec3, corners>& polygon, glm::dvec3 at,
                             glm::dvec3 normal) {
    double sum = 0.0;
    for (std::size_t i = 0; i < corners; ++i) {
        const glm::dvec3 a = glm::normalize(polygon[i] - at);
        const glm::dvec3 b = glm::normalize(polygon[(i + 1) % corners] - at);
        const glm::dvec3 across = glm::cross(a, b);
        sum += std::acos(glm::dot(a, b)) * glm::dot(glm::normalize(across), normal);
    }
    return std::abs(0.5 * sum);
}

/// From a sphere of unit radiance that lies wholly above the receiver's plane: π (R / d)² cos θ.
inline double irradiance_of_sphere(glm::dvec3 centre, double radius, glm::dvec3 at, glm::dvec3 normal) {
    const glm::dvec3 to_centre = centre - at;
    const double d = glm::length(to_centre);
    return 3.14159265358979323846 * radius * radius * glm::dot(to_centre, normal) / (d * d * d);
}

}  // namespace candela
