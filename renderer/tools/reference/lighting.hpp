#pragma once

#include <cstdint>
#include <vector>

#include "renderer/tools/reference/path_tracer.hpp"
#include "renderer/tools/reference/sampling.hpp"
#include "renderer/tools/reference/scene_content.hpp"
#include "renderer/tools/reference/surface.hpp"

namespace candela::reference {

/// Whether a light that faces a surface reaches it.
struct LightState {
    std::uint32_t light;  ///< index
    bool is_lit;
    bool operator==(const LightState&) const = default;
};

/// Light that comes directly from the scene's lights.
struct Direct {
    glm::vec3 radiance{0.0F};        ///< reflected by the surface
    std::vector<LightState> states;  ///< in the lights' order, without those that contribute almost nothing
};

/// From every light, each with a shadow ray unless it casts no shadow.
[[nodiscard]] Direct direct_light(const SceneContent& scene, const Surface& surface, Defect defect);

// Light that arrives by way of another surface is sampled in two ways. The first one looks around: a ray from
// the surface hits another surface, which samples the lights. It is noisy near a light, where 1/r² has no
// bound. The second one looks from the light: a ray from the light hits a surface, which is then connected to
// the receiver. It is noisy where surfaces meet. Each sample is weighted by the share of its way in the sum
// of both densities: the balance heuristic (Veach, "Robust Monte Carlo Methods for Light Transport
// Simulation", 1997, section 9.2.2). Both return the radiance that `receiver` reflects, divided by its
// albedo. Here, surfaces occlude even lights that cast no shadow: that flag is about what a camera sees, and
// bounced light would have no bound otherwise.

/// By way of `struck`, which was hit by a ray as the receiver looked around (see scattering.hpp). Samples one
/// light, with a probability proportional to its unoccluded contribution.
[[nodiscard]] glm::vec3 light_by_looking_around(const SceneContent& scene, const Surface& receiver,
                                                const Surface& struck, Sampler& sampler, Defect defect);

/// By way of the surface that a ray from one of the lights hits.
[[nodiscard]] glm::vec3 light_by_looking_from_light(const SceneContent& scene, const Surface& receiver,
                                                    Sampler& sampler, Defect defect);

}  // namespace candela::reference
