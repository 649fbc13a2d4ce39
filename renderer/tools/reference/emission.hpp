#pragma once

#include <vector>

#include <glm/vec2.hpp>

#include "renderer/tools/reference/geometry.hpp"
#include "renderer/tools/reference/lights.hpp"

namespace candela::reference {

/// Samples rays that leave the lights. A light is drawn with a probability proportional to its flux. Its ray
/// is uniformly distributed over its directions or, for a directional light, over the cross section of the
/// scene's bounding sphere.
class Emission {
 public:
    Emission(const std::vector<Light>& lights, const Sphere& bounds);

    struct Draw {
        std::uint32_t light;  ///< index
        Ray ray;
    };
    /// The scene must have lights. `which` and both components of `u` are in [0, 1).
    [[nodiscard]] Draw draw(float which, glm::vec2 u) const;

    /// The density per area (1/m²) with which rays of the light hit a surface that they reach. `cosine` is
    /// the cosine between the surface normal and the direction to the light.
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
