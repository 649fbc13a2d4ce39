#pragma once

#include <memory>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <candela/ecs/world.hpp>
#include <candela/scene/components.hpp>
#include "renderer/tools/reference/sampling.hpp"
#include "renderer/tools/reference/surface.hpp"

namespace candela::reference {

struct SceneContent;

/// The environment of a world.
class SkyLight {
 public:
    explicit SkyLight(const World& world);

    [[nodiscard]] bool any() const { return !until_.empty(); }

    /// The radiance that arrives from a direction of any length. The picture is interpolated bilinearly.
    [[nodiscard]] glm::vec3 radiance(glm::vec3 direction) const;

    /// A unit direction, drawn about in proportion to radiance. There must be a sky. Both components of `u`
    /// are in [0, 1).
    [[nodiscard]] glm::vec3 draw(glm::vec2 u) const;
    /// The density per solid angle (1/sr) with which a direction is drawn.
    [[nodiscard]] float density(glm::vec3 direction) const;

 private:
    [[nodiscard]] glm::vec2 texel_at(glm::vec3 direction) const;

    glm::vec3 scale_{0.0F};
    float rotation_ = 0.0F;
    std::shared_ptr<const SkyPicture> picture_;
    std::vector<double> until_;     ///< by texel: sum of the probabilities up to this one
    std::vector<float> densities_;  ///< by texel: 1/sr
};

/// The radiance that the surface reflects, divided by its albedo, of light that comes directly from the sky:
/// one sample. Two ways are combined with the balance heuristic (Veach, 1997, section 9.2.2): a direction
/// that the sky draws, and one in which the surface looks around.
[[nodiscard]] glm::vec3 light_of_sky(const SceneContent& scene, const Surface& surface, Sampler& sampler);

}  // namespace candela::reference
