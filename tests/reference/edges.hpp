#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>

#include "tests/reference/lighting.hpp"

namespace candela::reference {

/// What makes a pixel differ in kind from its neighbours.
struct PixelTrait {
    struct Layer {
        glm::vec3 position;
        glm::vec3 face;
        std::uint32_t part;
        std::vector<LightState> lights;
    };
    std::vector<Layer> layers;  ///< of what is seen, the nearest first
};

/// 1 for pixels that are at most `radius` away, along x and along y, from one of a pair of neighbours between
/// which another surface begins, the surface bends by more than 6°, or one of the lights begins or ends to be
/// hidden.
[[nodiscard]] std::vector<std::uint8_t> find_edges(const std::vector<PixelTrait>& pixels, glm::uvec2 size,
                                                   int radius);

}  // namespace candela::reference
