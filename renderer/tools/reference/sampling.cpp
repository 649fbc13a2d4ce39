#include "renderer/tools/reference/sampling.hpp"

#include <bit>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace candela::reference {

namespace {

/// SplitMix64 (Steele et al., 2014).
std::uint64_t mixed(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15U;
    x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
    x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
    return x ^ (x >> 31U);
}

std::uint32_t reversed(std::uint32_t x) {
    x = (x & 0x55555555U) << 1U | (x >> 1U & 0x55555555U);
    x = (x & 0x33333333U) << 2U | (x >> 2U & 0x33333333U);
    x = (x & 0x0f0f0f0fU) << 4U | (x >> 4U & 0x0f0f0f0fU);
    x = (x & 0x00ff00ffU) << 8U | (x >> 8U & 0x00ff00ffU);
    return x << 16U | x >> 16U;
}

/// A permutation in which a bit depends only on itself and lower bits: Owen scrambling of a number whose bits
/// are reversed. The constants are Vegdahl's ("Building a Better LK Hash", 2021), because the ones that were
/// published first are biased.
std::uint32_t permuted(std::uint32_t x, std::uint32_t seed) {
    x ^= x * 0x3d20adeaU;
    x += seed;
    x *= seed >> 16U | 1U;
    x ^= x * 0x05526c56U;
    return x ^ (x * 0x53a22864U);
}

/// The product with Pascal's triangle modulo 2, which generates Sobol's second dimension: bit i becomes the
/// parity of the bits whose index has all bits of i set.
std::uint32_t pascal(std::uint32_t x) {
    x ^= x >> 16U;
    x ^= (x & 0xff00ff00U) >> 8U;
    x ^= (x & 0xf0f0f0f0U) >> 4U;
    x ^= (x & 0xccccccccU) >> 2U;
    return x ^ ((x & 0xaaaaaaaaU) >> 1U);
}

/// Uses the upper 24 bits, so that the result is below 1.
float unit(std::uint32_t bits) {
    return static_cast<float>(bits >> 8U) * 0x1p-24F;
}

}  // namespace

Sampler::Sampler(std::uint64_t seed) : seed_(seed) {
    const auto draw = [&] { return static_cast<std::uint32_t>((seed_ = mixed(seed_)) >> 32U); };
    for (Scramble& scramble : scrambles_) scramble = {draw(), draw(), draw()};
}

void Sampler::start(std::uint32_t index) {
    path_ = index;
    direction_ = 0;
    state_ = mixed(seed_ ^ index);
}

glm::vec2 Sampler::next_direction() {
    if (direction_ >= spread_directions) {
        const float x = next();
        return {x, next()};
    }
    const Scramble& scramble = scrambles_[direction_++];
    const std::uint32_t index = reversed(permuted(reversed(path_), scramble.order));
    return {unit(reversed(permuted(index, scramble.x))), unit(reversed(permuted(pascal(index), scramble.y)))};
}

float Sampler::next() {
    state_ += 0x9e3779b97f4a7c15U;
    return unit(static_cast<std::uint32_t>(mixed(state_) >> 32U));
}

std::uint64_t pixel_seed(std::uint32_t seed, glm::uvec2 pixel, Numbers use) {
    const std::uint64_t place = static_cast<std::uint64_t>(pixel.y) << 32U | pixel.x;
    return mixed(mixed(static_cast<std::uint64_t>(seed) << 2U | static_cast<std::uint64_t>(use)) ^ place);
}

glm::vec3 across(glm::vec3 axis, float length, float angle) {
    const glm::vec3 apart = std::abs(axis.x) < 0.6F ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
    const glm::vec3 tangent = glm::normalize(glm::cross(apart, axis));
    const glm::vec3 bitangent = glm::cross(axis, tangent);
    return length * (std::cos(angle) * tangent + std::sin(angle) * bitangent);
}

glm::vec3 cosine_direction(glm::vec3 normal, glm::vec2 u) {
    // A point of the unit disc, lifted onto the hemisphere (Malley's method).
    const float angle = 2.0F * std::numbers::pi_v<float> * u.y;
    return across(normal, std::sqrt(u.x), angle) + std::sqrt(1.0F - u.x) * normal;
}

}  // namespace candela::reference
