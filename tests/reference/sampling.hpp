#pragma once

#include <array>
#include <cstdint>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace candela::reference {

/// Random numbers of one half of a pixel's paths. The first directions of its paths have well-spread points:
/// Sobol's first two dimensions, Owen-scrambled by hashing and shuffled anew for every direction (Burley,
/// "Practical Hash-based Owen Scrambling", JCGT 2020). All else is plain random.
class Sampler {
 public:
    /// Different seeds give independent numbers.
    explicit Sampler(std::uint64_t seed);

    /// Begins path `index`.
    void start(std::uint32_t index);
    /// In [0, 1)², for the path's next direction.
    [[nodiscard]] glm::vec2 next_direction();
    /// In [0, 1).
    [[nodiscard]] float next();

 private:
    struct Scramble {
        std::uint32_t order, x, y;
    };
    static constexpr std::size_t spread_directions = 8;
    std::array<Scramble, spread_directions> scrambles_{};
    std::uint64_t state_;
    std::uint32_t path_ = 0;
    std::size_t direction_ = 0;
};

/// The seed of a pixel's half.
[[nodiscard]] std::uint64_t pixel_seed(std::uint32_t seed, glm::uvec2 pixel, std::uint32_t half);

/// The vector of this length at right angles to a unit vector, at an angle (radians) from a fixed one of
/// those.
[[nodiscard]] glm::vec3 across(glm::vec3 axis, float length, float angle);

/// Direction above a surface, distributed as the cosine to its unit normal.
[[nodiscard]] glm::vec3 cosine_direction(glm::vec3 normal, glm::vec2 u);

}  // namespace candela::reference
