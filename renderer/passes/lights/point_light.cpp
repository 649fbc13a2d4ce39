#include <cmath>
#include <glm/geometric.hpp>

#include <candela/scene/hierarchy.hpp>
#include <candela/scene/lights.hpp>
#include "renderer/passes/lights/light_kind.hpp"

// Point lights; shaders/lights/point_light.glsl is the other half.

namespace candela {
namespace {

LightTable::Entry point_entry(Entity entity, const PointLight& light, const glm::mat4& world) {
    const glm::vec3 intensity = light.colour * light.intensity;
    return {.entity = entity,
            .light = {.position = glm::vec3(world[3]),
                      .kind = LIGHT_POINT,
                      .direction = glm::vec3(0.0F),
                      .range = light.range,
                      .intensity = intensity,
                      .cos_outer = 0.0F,
                      .shape = glm::vec2(0.0F)},
            .flux = intensity * (2.0F * hemisphere),
            .casts_shadow = light.casts_shadow};
}

void gather_point_lights(const WorldReader& world, SceneCheck& check, const SceneMetrics& /*metrics*/,
                         std::vector<LightTable::Entry>& entries) {
    gather_lights<PointLight>(world, check, entries, point_entry);
}

}  // namespace

const LightKind point_light{
    .gather = gather_point_lights,
    .bounds =
        [](const gpu::Light& light) {
            return LightBounds{light.position, light.range};
        },
    .shadow = [](const gpu::Light& light,
                 const SceneMetrics& metrics) { return shadow_around(light.position, metrics); }};

}  // namespace candela
