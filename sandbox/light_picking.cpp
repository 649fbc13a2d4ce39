#include "sandbox/light_picking.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <candela/scene/components.hpp>
#include <candela/scene/hierarchy.hpp>
#include "sandbox/scene.hpp"

namespace candela::sandbox {

namespace {

glm::vec3 position_of(const World& world, Entity entity) {
    return glm::vec3(world_matrix(world, entity)[3]);
}

template <class Light>
void add_markers(const World& world, std::vector<LightMarker>& markers) {
    for (auto [entity, light] : world.view<Light>())
        markers.push_back({entity, name_of(world, entity), light.colour, position_of(world, entity)});
}

}  // namespace

std::vector<LightMarker> light_markers(const World& world) {
    std::vector<LightMarker> markers;
    add_markers<PointLight>(world, markers);
    add_markers<SpotLight>(world, markers);
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

void move_to(World& world, Entity entity, const glm::vec3& position) {
    Transform transform;
    if (const auto* present = world.find<Transform>(entity)) transform = *present;
    const glm::mat4 parent = transform.parent ? world_matrix(world, transform.parent) : glm::mat4(1.0F);
    const glm::vec3 local(glm::inverse(parent) * glm::vec4(position, 1.0F));
    if (!std::isfinite(local.x + local.y + local.z)) return;
    transform.translation = local;
    world.set(entity, transform);
}

LightDrag::LightDrag(const World& world, const Viewport& viewport, Entity light, glm::vec2 pointer)
    : light_(light), grabbed_at_(position_of(world, light)) {
    if (const auto seen_at = project(viewport, grabbed_at_)) offset_ = *seen_at - pointer;
}

void LightDrag::drag(World& world, const Viewport& viewport, glm::vec2 pointer) const {
    const Ray ray = ray_through(viewport, pointer + offset_);
    if (const auto point = intersect_plane(ray, grabbed_at_, viewport.forward))
        move_to(world, light_, *point);
}

void nudge(World& world, Entity light, const Viewport& viewport, const glm::vec3& metres) {
    const glm::vec2 middle = viewport.size * 0.5F;
    const glm::vec3 aside = ray_through(viewport, middle + glm::vec2(1.0F, 0.0F)).origin;
    const glm::vec3 x = glm::normalize(aside - ray_through(viewport, middle).origin);
    const glm::vec3 y = glm::cross(x, viewport.forward);
    move_to(world, light,
            position_of(world, light) + metres.x * x + metres.y * y - metres.z * viewport.forward);
}

}  // namespace candela::sandbox
