#pragma once

#include <glm/vec3.hpp>

#include "renderer/tools/reference/bsdf.hpp"

namespace candela::reference {

/// The share of the light that arrives equally from all sides that a surface reflects, to all sides: the
/// albedo of the Lambertian surface that reflects as much of it. To 0.002.
[[nodiscard]] glm::vec3 hemispherical_albedo(const Gloss& gloss);

}  // namespace candela::reference
