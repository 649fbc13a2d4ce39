#pragma once

// Glossy materials, and closed forms of what they reflect.

#include <cmath>
#include <memory>
#include <numbers>

#include <glm/geometric.hpp>

#include "tests/renderer/scene_builder.hpp"

namespace candela {

inline std::shared_ptr<const Material> metal(glm::vec3 colour, float roughness) {
    Material material;
    material.base_colour = glm::vec4(colour, 1.0F);
    material.metalness = 1.0F;
    material.roughness = roughness;
    return std::make_shared<const Material>(std::move(material));
}

inline std::shared_ptr<const Material> plastic(glm::vec3 colour, float roughness) {
    Material material;
    material.base_colour = glm::vec4(colour, 1.0F);
    material.roughness = roughness;
    material.specular = 1.0F;
    return std::make_shared<const Material>(std::move(material));
}

/// glTF 2.0, appendix B.3.2: distribution of microfacets times their visibility.
inline double facets_towards(const glm::dvec3& light, const glm::dvec3& viewer, const glm::dvec3& normal,
                             double alpha) {
    const glm::dvec3 half = glm::normalize(light + viewer);
    const double a2 = alpha * alpha;
    const double nh = glm::dot(normal, half), nl = glm::dot(normal, light), nv = glm::dot(normal, viewer);
    const double d = a2 / (std::numbers::pi * std::pow(nh * nh * (a2 - 1.0) + 1.0, 2.0));
    // Correlated heights: Heitz, "Understanding the Masking-Shadowing Function", JCGT 2014, eq. 99.
    const auto lambda = [a2](double cosine) {
        return 0.5 * (std::sqrt(1.0 + a2 * (1.0 - cosine * cosine) / (cosine * cosine)) - 1.0);
    };
    return d / (1.0 + lambda(nl) + lambda(nv)) / (4.0 * nl * nv);
}

/// A ground of this material, seen from 2 m above at 45°, with a tiny view.
inline Scene seen_ground(std::shared_ptr<const Material> material) {
    Scene scene;
    add(scene.world, Transform{}, MeshInstance{square(4.0F, std::move(material))});
    scene.light = scene.world.create();
    scene.camera = add(scene.world, looking({2, 2, 0}, {0, 0, 0}), Camera{.vertical_fov = 0.02F});
    return scene;
}

inline constexpr glm::uvec2 few{9, 9};

inline double relative_error(double found, double expected) {
    return std::abs(found / expected - 1.0);
}

inline double luminance_at_middle(const Picture& picture) {
    return static_cast<double>(picture.at(picture.size.x / 2, picture.size.y / 2).g);
}

}  // namespace candela
