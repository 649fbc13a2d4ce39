#pragma once

#include <cstdint>
#include <vector>

#include "tests/reference/path_tracer.hpp"
#include "tests/reference/sampling.hpp"
#include "tests/reference/scene_content.hpp"
#include "tests/reference/surface.hpp"

namespace candela::reference {

/// Whether a light that shines onto a surface gets there.
struct LightState {
    std::uint32_t light;  ///< index
    bool is_lit;
    bool operator==(const LightState&) const = default;
};

/// Light that comes straight from the scene's lights.
struct Direct {
    glm::vec3 radiance{0.0F};        ///< reflected by the surface
    std::vector<LightState> states;  ///< in the lights' order, less those that would give next to nothing
};

/// By every light, each with a shadow ray unless it casts no shadow.
[[nodiscard]] Direct direct_light(const SceneContent& scene, const Surface& surface, Defect defect);

// Light that comes by way of another surface is found in two ways. One looks around: a ray from the surface
// strikes another one, which asks for the lights; it is lost near a light, whose 1/r² has no bound. The other
// looks from the light: a ray from there strikes a surface, which is then connected; it is lost where
// surfaces meet. Each is weighted by the share that it has in the density of both: the balance heuristic
// (Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997, section 9.2.2). Both give the
// radiance that `receiver` would reflect if it were white. Walls stop the light even of lights that cast no
// shadow: that flag is about what a camera sees, and bounced light would else have no limit.

/// By way of `struck`, which a ray from the receiver has met, cosine-distributed. One light is asked, drawn
/// in proportion to what each would give unoccluded.
[[nodiscard]] glm::vec3 light_by_looking_around(const SceneContent& scene, const Surface& receiver,
                                                const Surface& struck, Sampler& sampler, Defect defect);

/// By way of what a ray of one of the lights meets.
[[nodiscard]] glm::vec3 light_by_looking_from_light(const SceneContent& scene, const Surface& receiver,
                                                    Sampler& sampler, Defect defect);

}  // namespace candela::reference
