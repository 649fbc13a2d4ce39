#pragma once

#include "tests/reference/lighting.hpp"

namespace candela::reference {

/// Radiance that a surface reflects of light which has bounced before, by one path: it goes on from the
/// surface along directions distributed as the cosine and asks for the lights at every surface that it
/// strikes.
[[nodiscard]] glm::vec3 indirect_light(const SceneContent& scene, const Surface& seen, Sampler& sampler,
                                       const Settings& settings);

}  // namespace candela::reference
