#pragma once

#include <string_view>

#include "tests/renderer/scene_builder.hpp"

namespace candela {

/// A shipped scene: sandbox/scenes/<name>.gltf. It has a camera; `light` is null.
[[nodiscard]] Scene shipped_scene(std::string_view name);

/// A room of 4 m × 4 m × 4 m around the origin, without lights. A few hundred small triangles float in it, so
/// that tiles contain surfaces at many depths. The camera is at `eye` and looks along -z.
inline constexpr glm::vec3 eye{0.0F, 0.0F, 1.5F};
[[nodiscard]] Scene cluttered_room();

/// Adds `count` point and spot lights of limited range, without shadows, to the middle 3 m × 3 m × 3 m around
/// the origin, distributed by the golden ratio.
void add_ranged_lights(World& world, int count, float range);

/// The largest difference between a shading path and forward with all lights.
struct PathError {
    double error = 0.0;  ///< largest |a - b| / max(|b|, 1e-4 · mean of b) of all pixels, channels and paths
    ShadingPath path = ShadingPath::forward;  ///< the path with this error
    double reference_mean = 0.0;
};

/// The required agreement of paths. They add up the same terms. Only the rounding of a surface's position
/// (rasterised, or reconstructed from its depth) and of the sums over lights differ, which is about 1e-6.
/// Where a light fades out, the rounding of its distance to the surface is large compared with the remaining
/// light, hence the floor in PathError: 1e-4 of the picture's mean.
inline constexpr double path_tolerance = 1e-3;

class PathFixture : public RenderFixture {
 protected:
    /// Renders the scene with every path, with all other settings as in `base`.
    [[nodiscard]] PathError worst_path(const Scene& scene, glm::uvec2 size, Configuration base);

    /// The same; checks the error, and that the picture is not black.
    void check_paths(const Scene& scene, glm::uvec2 size, const Configuration& base);
};

/// Linear radiance, without indirect light and shadows.
[[nodiscard]] Configuration direct_only();

}  // namespace candela
