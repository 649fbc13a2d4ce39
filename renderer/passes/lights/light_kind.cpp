#include "renderer/passes/lights/light_kind.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace candela {
namespace {

/// The radius of a sphere around the scene's centre that contains the scene, as rounded numbers see it from
/// `distance` away.
float radius_from(float distance, const SceneMetrics& metrics) {
    return 1.01F * metrics.radius() + 1e-6F * distance;
}

/// The depths of the scene. Around a light that is in it they begin near the light and have no end.
void set_depths(ShadowShape& shape, glm::vec3 position, const SceneMetrics& metrics) {
    const glm::vec3 to_centre = metrics.centre() - position;
    const float radius = radius_from(glm::length(to_centre), metrics);
    const float depth = glm::dot(shape.axis, to_centre);
    const bool outside = depth - radius > least_depth(metrics);
    shape.near = outside ? depth - radius : least_depth(metrics);
    shape.far = outside ? depth + radius : std::numeric_limits<float>::infinity();
}

}  // namespace

ShadowShape shadow_around(glm::vec3 position, const SceneMetrics& metrics) {
    ShadowShape shape;
    const glm::vec3 to_centre = metrics.centre() - position;
    const float distance = glm::length(to_centre);
    const float sine = radius_from(distance, metrics) / std::max(distance, 1e-30F);
    const float cosine = std::sqrt(std::max(1.0F - sine * sine, 0.0F));
    if (cosine > cos_widest_map)
        return shadow_in_cone(position, to_centre / distance, sine / cosine, metrics);
    set_depths(shape, position, metrics);
    return shape;
}

ShadowShape shadow_in_cone(glm::vec3 position, glm::vec3 axis, float tangent, const SceneMetrics& metrics) {
    ShadowShape shape{.kind = SHADOW_PERSPECTIVE, .axis = axis, .tangent = tangent};
    set_depths(shape, position, metrics);
    return shape;
}

}  // namespace candela
