#include "renderer/passes/lights/lights.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include <candela/graph/execute.hpp>
#include <candela/scene/components.hpp>
#include <candela/scene/hierarchy.hpp>

namespace candela {
namespace {

constexpr float hemisphere = 2.0F * std::numbers::pi_v<float>;  // steradians

bool emits(glm::vec3 intensity) {
    return intensity.r > 0.0F || intensity.g > 0.0F || intensity.b > 0.0F;
}

glm::vec3 position_of(const glm::mat4& world) {
    return glm::vec3(world[3]);
}

/// Direction in which the light travels: its local -Z axis.
glm::vec3 direction_of(const glm::mat4& world) {
    const glm::vec3 axis(world[2]);
    const float length = glm::length(axis);
    return length > 0.0F ? -axis / length : glm::vec3(0.0F, 0.0F, -1.0F);
}

constexpr int no_shadow = -1;  // add_light_upload sets the index

LightTable::Entry point_entry(Entity entity, const PointLight& light, const glm::mat4& world) {
    const glm::vec3 intensity = light.colour * light.intensity;
    return {.entity = entity,
            .light = {.position = position_of(world),
                      .kind = LIGHT_POINT,
                      .direction = glm::vec3(0.0F),
                      .range = light.range,
                      .intensity = intensity,
                      .shadow = no_shadow,
                      .shape = glm::vec2(0.0F),
                      .cos_inner = 0.0F,
                      .cos_outer = 0.0F},
            .flux = intensity * (2.0F * hemisphere),
            .casts_shadow = light.casts_shadow};
}

/// The intensity is constant inside the inner cone. From there to the outer cone it falls with the square of
/// a linear ramp in the cosine (KHR_lights_punctual). Its integral over the sphere is
/// 2π ((1 - cᵢ) + (cᵢ - cₒ) / 3), with the cosines cᵢ and cₒ of the inner and outer cone.
LightTable::Entry spot_entry(Entity entity, const SpotLight& light, const glm::mat4& world) {
    const float cos_outer = std::cos(light.outer_cone);
    // The ramp is at least a thousandth of the cone, which avoids a division by zero as the extension
    // suggests.
    const float ramp = std::max(std::cos(light.inner_cone) - cos_outer, 1e-3F * (1.0F - cos_outer));
    const float cos_inner = cos_outer + ramp;
    const glm::vec3 intensity = light.colour * light.intensity;
    return {.entity = entity,
            .light = {.position = position_of(world),
                      .kind = LIGHT_SPOT,
                      .direction = direction_of(world),
                      .range = light.range,
                      .intensity = intensity,
                      .shadow = no_shadow,
                      .shape = {1.0F / ramp, -cos_outer / ramp},
                      .cos_inner = cos_inner,
                      .cos_outer = cos_outer},
            .flux = intensity * (hemisphere * ((1.0F - cos_inner) + ramp / 3.0F)),
            .casts_shadow = light.casts_shadow};
}

/// The footprint is the bounding rectangle of the scene's box as seen by the light, placed in front of the
/// scene.
LightTable::Entry directional_entry(Entity entity, const DirectionalLight& light, const glm::mat4& world,
                                    const SceneMetrics& metrics) {
    const glm::vec3 direction = direction_of(world);
    const auto [tangent, bitangent] = basis_around(direction);
    const glm::vec3 half = (metrics.upper - metrics.lower) * 0.5F;
    const auto half_extent = [&](glm::vec3 axis) { return glm::dot(glm::abs(axis), half); };
    const glm::vec2 shape(half_extent(tangent), half_extent(bitangent));
    const glm::vec3 illuminance = light.colour * light.illuminance;
    return {.entity = entity,
            // One percent of slack, so that the scene's foremost points do not lie in the footprint.
            .light = {.position = metrics.centre() - direction * (1.01F * half_extent(direction)),
                      .kind = LIGHT_DIRECTIONAL,
                      .direction = direction,
                      .range = std::numeric_limits<float>::infinity(),
                      .intensity = illuminance,
                      .shadow = no_shadow,
                      .shape = shape,
                      .cos_inner = 0.0F,
                      .cos_outer = 0.0F},
            .flux = illuminance * (4.0F * shape.x * shape.y),
            .casts_shadow = light.casts_shadow};
}

LightTable gather(const World& world, const SceneMetrics& metrics) {
    LightTable table;
    for (const auto& [entity, light] : world.view<PointLight>()) {
        table.entries.push_back(point_entry(entity, light, world_matrix(world, entity)));
    }
    for (const auto& [entity, light] : world.view<SpotLight>()) {
        table.entries.push_back(spot_entry(entity, light, world_matrix(world, entity)));
    }
    for (const auto& [entity, light] : world.view<DirectionalLight>()) {
        table.entries.push_back(directional_entry(entity, light, world_matrix(world, entity), metrics));
    }
    std::erase_if(table.entries,
                  [](const LightTable::Entry& entry) { return !emits(entry.light.intensity); });
    return table;
}

}  // namespace

Basis basis_around(glm::vec3 n) {
    const float s = n.z >= 0.0F ? 1.0F : -1.0F;
    const float a = -1.0F / (s + n.z);
    const float b = n.x * n.y * a;
    return {{1.0F + s * n.x * n.x * a, s * b, -s * n.x}, {b, s + n.y * n.y * a, -n.y}};
}

ValueHandle<LightTable> add_lights(FrameGraph& graph, ValueHandle<SceneMetrics> metrics) {
    return graph.add("lights", [&](Pass& pass) {
        pass.read<PointLight>();
        pass.read<SpotLight>();
        pass.read<DirectionalLight>();
        pass.read<Transform>();
        pass.read(metrics);
        const auto lights = pass.write(graph.value<LightTable>("lights"));
        pass.run([=](Execution& run) { run.set(lights, gather(run.world(), run.value(metrics))); });
        return lights;
    });
}

}  // namespace candela
