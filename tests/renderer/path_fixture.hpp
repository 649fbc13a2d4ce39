#pragma once

#include <string_view>

#include "tests/renderer/scene_builder.hpp"

namespace candela {

/// A shipped scene: sandbox/scenes/<name>.gltf. It has a camera; `light` is null.
[[nodiscard]] Scene shipped_scene(std::string_view name);

/// A room of 4 m × 4 m × 4 m around the origin, without lights, with a few hundred small triangles floating
/// in it, so that tiles hold surfaces of many depths. The camera stands at `eye` and looks along -z.
inline constexpr glm::vec3 eye{0.0F, 0.0F, 1.5F};
[[nodiscard]] Scene cluttered_room();

/// `count` points and spots of limited range in the middle 3 m × 3 m × 3 m around the origin, without
/// shadows, spread by the golden ratio.
void add_ranged_lights(World& world, int count, float range);

/// How far shading paths are from forward with all lights.
struct PathError {
    double error = 0.0;  ///< largest |a - b| / max(|b|, 1e-4 · mean of b) of all pixels, channels and paths
    ShadingPath path = ShadingPath::forward;  ///< whose it is
    double reference_mean = 0.0;
};

/// What paths may differ by, as asked of them. They add up the same terms; only the roundings of a surface's
/// position, rasterised here and found from its depth there, and of its lights' sums differ, which is 1e-6 or
/// so. Where a light fades out the rounding of its distance to the surface is large beside what is left of
/// it, hence the floor in PathError: a ten-thousandth of the picture's mean.
inline constexpr double path_tolerance = 1e-3;

class PathFixture : public RenderFixture {
 protected:
    /// Renders the scene by every path, all else as in `base`.
    [[nodiscard]] PathError worst_path(const Scene& scene, glm::uvec2 size, Configuration base);

    /// The same, and checks it, and that there was anything to see.
    void check_paths(const Scene& scene, glm::uvec2 size, const Configuration& base);
};

/// Linear radiance, without indirect light and shadows.
[[nodiscard]] Configuration direct_only();
/// Linear radiance with a few VPLs and small shadow maps.
[[nodiscard]] Configuration few_vpls();

}  // namespace candela
