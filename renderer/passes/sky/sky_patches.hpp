#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <candela/scene/components.hpp>
#include "renderer/gpu/gpu_types.hpp"
#include "renderer/passes/sky/sky_grid.hpp"

namespace candela {

/// A rectangle of cells: `first` inclusive, `last` exclusive; and the sums over these: see SkyGrid::Cell.
struct SkyPatch {
    glm::uvec2 first{0};
    glm::uvec2 last{0};
    glm::dvec3 light{0.0};
    glm::dvec3 moment{0.0};
};

/// Cosine of the radius of a sun with its surroundings, 1 degree.
inline constexpr float sun_cosine = 0.99984770F;
/// Of 2 degrees: nothing else within is as bright.
inline constexpr float around_sun_cosine = 0.99939083F;

/// A small bright part of the sky.
struct SkySun {
    glm::vec3 direction{0.0F};  ///< towards it, unit, in the picture's directions
    glm::vec3 light{0.0F};      ///< its radiance, integrated over its solid angle
};

/// A sky, divided into suns and patches.
struct SplitSky {
    std::vector<SkySun> suns;
    std::shared_ptr<const SkyGrid> grid;  ///< without the suns
    std::vector<SkyPatch> patches;
};

/// How many patches the sky has where there are about `count` VPLs. Each pixel traces rays to its share of
/// them: see max_vpls_per_invocation.
[[nodiscard]] constexpr std::uint32_t sky_patches(std::uint32_t count) {
    return std::clamp(count / 2, 128U, std::uint32_t{MOST_SKY_PATCHES});
}

/// Divides a picture of the sky; null: a sky of radiance 1 everywhere. What is at most 2 degrees wide and has
/// at least a twentieth of the light is a sun, which is to be shown as a directional light. The rest becomes
/// at most `count` patches: the one with the largest product of light and width is split, again and again,
/// into halves of equal light (after Debevec, "A Median Cut Algorithm for Light Probe Sampling", 2005, who
/// splits them all alike).
[[nodiscard]] SplitSky split_sky(const SkyPicture* picture, std::uint32_t count);

/// A direction of the picture as it appears in the world, turned by Environment::rotation.
[[nodiscard]] glm::vec3 rotated_sky(glm::vec3 direction, float rotation);

/// The patches with their light. Sample 0: each at its mean direction, as wide as it is; else in one of its
/// directions, drawn by radiance, so that the mean over all samples converges to the whole sky.
[[nodiscard]] std::vector<gpu::SkyPatch> place_sky(const SplitSky& sky, const Environment& environment,
                                                   std::uint32_t sample);

}  // namespace candela
