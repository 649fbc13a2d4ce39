#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include <candela/scene/hierarchy.hpp>
#include <candela/scene/lights.hpp>
#include "renderer/passes/lights/light_kind.hpp"

// Directional lights; shaders/lights/directional_light.glsl is the other half.

namespace candela {
namespace {

void gather_directional_lights(const WorldReader& world, SceneCheck& check, const SceneMetrics& metrics,
                               std::vector<LightTable::Entry>& entries) {
    gather_lights<DirectionalLight>(
        world, check, entries, [&](Entity entity, const DirectionalLight& light, const glm::mat4& matrix) {
            return directional_entry(
                entity, {direction_of(matrix), light.colour * light.illuminance, light.casts_shadow},
                metrics);
        });
}

/// The light is in front of the scene; the map reaches as far behind its centre.
ShadowShape shadow_of_directional(const gpu::Light& light, const SceneMetrics& metrics) {
    const float least = least_depth(metrics);
    return {.kind = SHADOW_ORTHOGRAPHIC,
            .axis = light.direction,
            .half_extent = glm::max(light.shape, glm::vec2(least)),
            .far = std::max(2.0F * glm::length(metrics.centre() - light.position), least)};
}

}  // namespace

/// The footprint is the bounding rectangle of the scene's box as seen by the light, placed in front of the
/// scene.
LightTable::Entry directional_entry(Entity entity, const ParallelLight& light, const SceneMetrics& metrics) {
    const auto [tangent, bitangent] = basis_around(light.direction);
    const glm::vec3 half = (metrics.upper - metrics.lower) * 0.5F;
    const auto half_extent = [&](glm::vec3 axis) { return glm::dot(glm::abs(axis), half); };
    const glm::vec2 shape(half_extent(tangent), half_extent(bitangent));
    return {.entity = entity,
            // One percent of slack, so that the scene's foremost points do not lie in the footprint.
            .light = {.position = metrics.centre() - light.direction * (1.01F * half_extent(light.direction)),
                      .kind = LIGHT_DIRECTIONAL,
                      .direction = light.direction,
                      .range = std::numeric_limits<float>::infinity(),
                      .intensity = light.illuminance,
                      .cos_outer = 0.0F,
                      .shape = shape},
            .flux = light.illuminance * (4.0F * shape.x * shape.y),
            .casts_shadow = light.casts_shadow};
}

const LightKind directional_light{.gather = gather_directional_lights,
                                  .bounds =
                                      [](const gpu::Light& light) {
                                          return LightBounds{light.position, light.range};
                                      },
                                  .shadow = shadow_of_directional};

}  // namespace candela
