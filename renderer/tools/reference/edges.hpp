#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>

#include "renderer/tools/reference/lighting.hpp"

namespace candela::reference {

/// What distinguishes a pixel from its neighbours.
struct PixelTrait {
    struct Layer {
        glm::vec3 position;
        glm::vec3 face;
        std::uint32_t part;
        std::vector<LightState> lights;
    };
    std::vector<Layer> layers;  ///< visible surfaces, nearest first
};

/// A mask that is 1 within `radius` pixels, along x and along y, of an edge. An edge is between two
/// neighbouring pixels if they show different surfaces, if the surface bends by more than 6° between them, or
/// if a light is occluded at only one of them.
[[nodiscard]] std::vector<std::uint8_t> find_edges(const std::vector<PixelTrait>& pixels, glm::uvec2 size,
                                                   int radius);

}  // namespace candela::reference
