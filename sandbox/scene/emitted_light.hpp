#pragma once

#include <random>
#include <vector>

#include <glm/vec3.hpp>

#include <candela/ecs/world.hpp>
#include <candela/scene/components.hpp>
#include "sandbox/editing/scene_rays.hpp"
#include "sandbox/editing/viewport.hpp"

namespace candela::sandbox {

/// The light that arrives from the surfaces of a world that emit light, without bounces. It is found by
/// random rays, the same for the same calls. Of emission textures, the mean counts.
class EmittedLight {
 public:
    explicit EmittedLight(const World& world);

    /// Whether any surface emits light.
    [[nodiscard]] bool any() const { return !flux_.empty(); }
    /// The radiance that a white surface would have at a point; cd/m². The mean of so many rays.
    [[nodiscard]] float on_white(const glm::vec3& point, const glm::vec3& normal, int rays);
    /// The share, from 0 to 1, of the surfaces in a picture of which `on_white` is more than `least`. Looks
    /// at each pixel.
    [[nodiscard]] float lit_share(const Viewport& viewport, float least);

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

    std::vector<EmittingTriangle> triangles_;
    std::vector<double> flux_;  // of each triangle's front, lm
    std::discrete_distribution<std::size_t> by_flux_;
    SceneRays surfaces_;
    std::mt19937 random_{1};
};

}  // namespace candela::sandbox
