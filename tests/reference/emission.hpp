#pragma once

#include <vector>

#include <glm/vec2.hpp>

#include "tests/reference/geometry.hpp"
#include "tests/reference/lights.hpp"

namespace candela::reference {

/// Rays of light as they leave the lights: a light is drawn in proportion to its flux, and a ray of it evenly
/// among its directions or, for a directional one, among the places at which it meets the scene.
class Emission {
 public:
    Emission(const std::vector<Light>& lights, const Sphere& bounds);

    struct Draw {
        std::uint32_t light;  ///< index
        Ray ray;
    };
    /// The scene must have lights. All of `u` in [0, 1).
    [[nodiscard]] Draw draw(float which, glm::vec2 u) const;

    /// Density, by area, with which rays of the light meet a surface that they reach, 1/m². `cosine` is that
    /// between the surface's normal and the light.
    [[nodiscard]] float density(std::uint32_t light, const Arrival& arrival, float cosine) const;

 private:
    struct Source {
        Light light;
        float probability;  ///< of being drawn
        float until;        ///< sum of the probabilities up to this one
    };
    Sphere bounds_;
    std::vector<Source> sources_;
};

}  // namespace candela::reference
