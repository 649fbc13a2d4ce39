#pragma once

#include <cstddef>
#include <span>

#include <candela/scene/animation.hpp>

namespace candela {

/// A time between two keys of a sampler: `share` of the way from key `before` to key `after`.
struct KeyPosition {
    std::size_t before = 0;
    std::size_t after = 0;  ///< equals `before` before the first key, after the last, and at one
    float share = 0.0F;     ///< in [0, 1]
    float seconds = 0.0F;   ///< between the two keys
};

/// Where `seconds` is among ascending times, of which there is at least one.
[[nodiscard]] KeyPosition find_keys(std::span<const float> times, double seconds);

/// The sampler's value there: as many components as `value` has. `is_rotation`: a unit quaternion x, y, z, w.
/// The sampler has enough values: see fault_of.
void sample(const AnimationSampler& sampler, const KeyPosition& at, bool is_rotation, std::span<float> value);

/// The numbers that a sampler with so many components needs.
[[nodiscard]] inline std::size_t values_needed(const AnimationSampler& sampler, std::size_t components) {
    const std::size_t parts = sampler.interpolation == Interpolation::cubic_spline ? 3 : 1;
    return sampler.times->size() * parts * components;
}

}  // namespace candela
