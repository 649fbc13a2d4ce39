#pragma once

#include <algorithm>
#include <cstddef>
#include <random>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include <candela/ecs/world.hpp>
#include <candela/scene/components.hpp>
#include <candela/tools/scene_rays.hpp>
#include "sandbox/editing/viewport.hpp"

namespace candela::sandbox {

/// The surface at the centre of each unit square of a picture, where there is one.
[[nodiscard]] std::vector<tools::SurfaceHit> seen_surfaces(const tools::SceneRays& surfaces,
                                                           const Viewport& viewport);

/// The share of surfaces, from 0 to 1, that `is_lit(const SurfaceHit&)`; 0 of none.
template <class IsLit>
[[nodiscard]] float lit_share(std::span<const tools::SurfaceHit> seen, IsLit&& is_lit) {
    if (seen.empty()) return 0.0F;
    return static_cast<float>(std::ranges::count_if(seen, is_lit)) / static_cast<float>(seen.size());
}

/// The point lights and spot lights of a world, as far as they shine at all. `surfaces` must outlive it.
class LampLight {
 public:
    LampLight(const World& world, const tools::SceneRays& surfaces);

    [[nodiscard]] bool any() const { return !lamps_.empty(); }
    /// Whether any of them shines on the front of a surface, without bounces.
    [[nodiscard]] bool reaches(const tools::SurfaceHit& surface) const;

 private:
    /// World space, metres.
    struct Lamp {
        glm::vec3 position;
        glm::vec3 axis;  ///< along which it shines, unit
        float range;
        float least_cosine;  ///< between the axis and where it shines
    };

    const tools::SceneRays& surfaces_;
    std::vector<Lamp> lamps_;
};

/// The light that arrives from the surfaces of a world that emit light, without bounces. It is found by
/// random rays, the same for the same calls. Of emission textures, the mean counts. `surfaces` must outlive
/// it.
class EmittedLight {
 public:
    EmittedLight(const World& world, const tools::SceneRays& surfaces);

    /// Whether any surface emits light.
    [[nodiscard]] bool any() const { return !flux_.empty(); }
    /// The radiance that a white surface would have at a point; cd/m². The mean of so many rays.
    [[nodiscard]] float on_white(const glm::vec3& point, const glm::vec3& normal, int rays);

 private:
    /// World space, metres; the front is counter-clockwise.
    struct EmittingTriangle {
        glm::vec3 a;
        glm::vec3 ab;
        glm::vec3 ac;
        bool double_sided;
    };

    void add(const Primitive& primitive, const glm::mat4& to_world);
    [[nodiscard]] float draw_geometry(const glm::vec3& point, const glm::vec3& normal);
    [[nodiscard]] float unit() { return std::uniform_real_distribution<float>(0.0F, 1.0F)(random_); }

    const tools::SceneRays& surfaces_;
    std::vector<EmittingTriangle> triangles_;
    std::vector<double> flux_;  // of each triangle's front, lm
    std::discrete_distribution<std::size_t> by_flux_;
    std::mt19937 random_{1};
};

}  // namespace candela::sandbox
