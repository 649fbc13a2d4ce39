#pragma once

#include "renderer/tools/reference/lighting.hpp"

namespace candela::reference {

/// The radiance that a surface reflects of indirect light, from one path. The path continues from the surface
/// in directions in which surfaces look around (see scattering.hpp), and samples the lights at every surface
/// that it hits.
[[nodiscard]] glm::vec3 indirect_light(const SceneContent& scene, const Surface& seen, Sampler& sampler,
                                       const Settings& settings);

}  // namespace candela::reference
