#include "engine/animation/sample.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

namespace candela {

namespace {

/// The components of a key's value, or of one of its tangents.
const float* part_of_key(const AnimationSampler& sampler, std::size_t key, std::size_t components,
                         std::size_t part) {
    const std::size_t parts = sampler.interpolation == Interpolation::cubic_spline ? 3 : 1;
    return sampler.values->data() + (key * parts + part) * components;
}

/// The value itself.
const float* value_of_key(const AnimationSampler& sampler, std::size_t key, std::size_t components) {
    return part_of_key(sampler, key, components,
                       sampler.interpolation == Interpolation::cubic_spline ? 1 : 0);
}

glm::vec4 rotation_at(const float* values) {
    return {values[0], values[1], values[2], values[3]};
}

/// On the shortest arc, at constant speed (glTF 2.0, appendix C.4).
glm::vec4 slerp(const glm::vec4& a, const glm::vec4& b, float share) {
    const float cosine = glm::dot(a, b);
    const glm::vec4 nearer = cosine < 0.0F ? -b : b;
    // Here, chord and arc differ by less than a float can tell: angle²/8 < 2^-24.
    constexpr float nearly_equal = 1.0F - 1e-7F;
    if (std::abs(cosine) > nearly_equal) return glm::mix(a, nearer, share);
    const float angle = std::acos(std::abs(cosine));
    return (std::sin((1.0F - share) * angle) * a + std::sin(share * angle) * nearer) / std::sin(angle);
}

/// Appendix C.5.
void sample_spline(const AnimationSampler& sampler, const KeyPosition& at, std::span<float> value) {
    const std::size_t n = value.size();
    const float* const from = part_of_key(sampler, at.before, n, 1);
    const float* const leaving = part_of_key(sampler, at.before, n, 2);
    const float* const arriving = part_of_key(sampler, at.after, n, 0);
    const float* const to = part_of_key(sampler, at.after, n, 1);
    const float t = at.share;
    const float t2 = t * t;
    const float t3 = t2 * t;
    for (std::size_t i = 0; i < n; ++i) {
        value[i] = (2.0F * t3 - 3.0F * t2 + 1.0F) * from[i] + at.seconds * (t3 - 2.0F * t2 + t) * leaving[i] +
                   (3.0F * t2 - 2.0F * t3) * to[i] + at.seconds * (t3 - t2) * arriving[i];
    }
}

void normalise(std::span<float> rotation) {
    const glm::vec4 parts = rotation_at(rotation.data());
    const float length = glm::length(parts);
    if (!(length > 0.0F)) return;
    for (int i = 0; i < 4; ++i) rotation[static_cast<std::size_t>(i)] = parts[i] / length;
}

}  // namespace

KeyPosition find_keys(std::span<const float> times, double seconds) {
    const auto at = static_cast<float>(seconds);
    if (!(at > times.front())) return {};
    const std::size_t last = times.size() - 1;
    if (at >= times[last]) return {last, last, 0.0F, 0.0F};
    const auto after = static_cast<std::size_t>(std::ranges::upper_bound(times, at) - times.begin());
    const std::size_t before = after - 1;
    const float between = times[after] - times[before];
    return {before, after, (at - times[before]) / between, between};
}

void sample(const AnimationSampler& sampler, const KeyPosition& at, bool is_rotation,
            std::span<float> value) {
    const std::size_t n = value.size();
    const float* const from = value_of_key(sampler, at.before, n);
    if (at.before == at.after || sampler.interpolation == Interpolation::step) {
        std::copy_n(from, n, value.data());
    } else if (sampler.interpolation == Interpolation::cubic_spline) {
        sample_spline(sampler, at, value);
    } else if (is_rotation) {
        const glm::vec4 between =
            slerp(rotation_at(from), rotation_at(value_of_key(sampler, at.after, n)), at.share);
        for (int i = 0; i < 4; ++i) value[static_cast<std::size_t>(i)] = between[i];
    } else {
        const float* const to = value_of_key(sampler, at.after, n);
        for (std::size_t i = 0; i < n; ++i) value[i] = (1.0F - at.share) * from[i] + at.share * to[i];
    }
    if (is_rotation) normalise(value);
}

}  // namespace candela
