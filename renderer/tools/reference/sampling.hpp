#pragma once

#include <array>
#include <cstdint>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace candela::reference {

/// Random numbers for one half of a pixel's paths. Those of a path depend only on the seed and its index. The
/// first directions of its paths use well-distributed points: the first two dimensions of Sobol's sequence,
/// Owen-scrambled by hashing and shuffled differently for every direction (Burley, "Practical Hash-based Owen
/// Scrambling", JCGT 2020). Everything else is pseudo-random.
class Sampler {
 public:
    /// Different seeds give independent numbers.
    explicit Sampler(std::uint64_t seed);

    /// Starts path `index`. Call it before drawing numbers.
    void start(std::uint32_t index);
    /// A point in [0, 1)², for the path's next direction.
    [[nodiscard]] glm::vec2 next_direction();
    /// In [0, 1).
    [[nodiscard]] float next();

 private:
    struct Scramble {
        std::uint32_t order, x, y;
    };
    static constexpr std::size_t spread_directions = 8;
    std::array<Scramble, spread_directions> scrambles_{};
    std::uint64_t seed_;
    std::uint64_t state_ = 0;
    std::uint32_t path_ = 0;
    std::size_t direction_ = 0;
};

/// What the random numbers of a pixel are for.
enum class Numbers : std::uint8_t { first_half, second_half, direct_light };

/// The seed for some of the random numbers of a pixel.
[[nodiscard]] std::uint64_t pixel_seed(std::uint32_t seed, glm::uvec2 pixel, Numbers use);

/// A vector of this length, perpendicular to the unit vector `axis`. `angle` (radians) is measured from a
/// fixed perpendicular direction.
[[nodiscard]] glm::vec3 across(glm::vec3 axis, float length, float angle);

/// A cosine-distributed direction above a surface with this unit normal.
[[nodiscard]] glm::vec3 cosine_direction(glm::vec3 normal, glm::vec2 u);

}  // namespace candela::reference
