#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "renderer/tools/reference/geometry.hpp"
#include "renderer/tools/reference/sampling.hpp"
#include "renderer/tools/reference/surface.hpp"

namespace candela::reference {

struct SceneContent;

/// The solid triangles that emit light.
class Emitters {
 public:
    explicit Emitters(const Geometry& geometry);

    [[nodiscard]] bool any() const { return !sources_.empty(); }

    /// A point on a triangle that is drawn with a probability proportional to area times emission (without
    /// its texture), uniformly distributed on it. There must be emitters. `which` and both components of `u`
    /// are in [0, 1).
    struct Draw {
        std::uint32_t triangle;  ///< index in the geometry
        glm::vec2 weights;       ///< of the second and the third corner
    };
    [[nodiscard]] Draw draw(float which, glm::vec2 u) const;
    /// The density per area (1/m²) with which points of this triangle are drawn; 0 if it does not emit.
    [[nodiscard]] float density(std::uint32_t triangle) const { return density_[triangle]; }

 private:
    struct Source {
        std::uint32_t triangle;
        float until;  ///< sum of the probabilities up to this one
    };
    std::vector<Source> sources_;
    std::vector<float> density_;  ///< by triangle
};

/// The radiance that the surface reflects, divided by its albedo, of light that comes directly from emitters:
/// one sample. Two ways are combined with the balance heuristic (Veach, 1997, section 9.2.2): a point on an
/// emitter, which is noisy close to it and at smooth surfaces, and looking around, which is noisy far from
/// it.
[[nodiscard]] glm::vec3 light_of_emitters(const SceneContent& scene, const Surface& surface,
                                          Sampler& sampler);

}  // namespace candela::reference
