#pragma once

#include <random>

#include <candela/tools/picture.hpp>

namespace candela::study {

[[nodiscard]] inline tools::Picture constant(glm::ivec2 size, glm::vec3 value) {
    return {size, std::vector<glm::vec3>(static_cast<std::size_t>(size.x * size.y), value)};
}

/// Channels are uniformly distributed over [0, 1), the same for a seed on every machine.
[[nodiscard]] inline tools::Picture noise(glm::ivec2 size, std::uint32_t seed) {
    std::mt19937 bits(seed);
    const auto value = [&] { return static_cast<float>(bits() >> 8) / 16777216.0F; };
    tools::Picture picture = constant(size, glm::vec3(0.0F));
    for (glm::vec3& pixel : picture.pixels) {
        for (int channel = 0; channel < 3; ++channel) pixel[channel] = value();
    }
    return picture;
}

}  // namespace candela::study
