#include "sandbox/editing/light_picking.hpp"

#include <algorithm>

#include <glm/geometric.hpp>

#include <candela/scene/lights.hpp>
#include "sandbox/editing/placing.hpp"
#include "sandbox/scene/scene.hpp"

namespace candela::sandbox {

std::vector<LightMarker> light_markers(const World& world) {
    std::vector<LightMarker> markers;
    visit_lights(world, [&]<class Light>(Entity entity, const Light& light) {
        if (light_traits<Light>.has_position) {
            markers.push_back({entity, name_of(world, entity), light.colour, position_of(world, entity)});
        }
    });
    std::sort(markers.begin(), markers.end(),
              [](const LightMarker& a, const LightMarker& b) { return a.entity < b.entity; });
    return markers;
}

std::optional<Entity> pick(const std::vector<LightMarker>& markers, const Viewport& viewport,
                           glm::vec2 position, float radius) {
    std::optional<Entity> nearest;
    for (const LightMarker& marker : markers) {
        const std::optional<glm::vec2> seen_at = project(viewport, marker.position);
        if (!seen_at || glm::distance(*seen_at, position) > radius) continue;
        radius = glm::distance(*seen_at, position);
        nearest = marker.entity;
    }
    return nearest;
}

void nudge(World& world, Entity entity, const Viewport& viewport, const glm::vec3& metres) {
    const glm::vec2 middle = viewport.origin + viewport.size * 0.5F;
    const glm::vec3 aside = ray_through(viewport, middle + glm::vec2(1.0F, 0.0F)).origin;
    const glm::vec3 x = glm::normalize(aside - ray_through(viewport, middle).origin);
    const glm::vec3 y = glm::cross(x, viewport.forward);
    move_to(world, entity,
            position_of(world, entity) + metres.x * x + metres.y * y - metres.z * viewport.forward);
}

}  // namespace candela::sandbox
