#include "sandbox/editing/placing.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <candela/scene/hierarchy.hpp>

namespace candela::sandbox {

namespace {

bool is_finite(const glm::vec3& v) {
    return std::isfinite(v.x + v.y + v.z);
}

bool is_finite(const glm::quat& q) {
    return std::isfinite(q.x + q.y + q.z + q.w);
}

glm::mat4 parent_matrix(const World& world, const Transform& transform) {
    return transform.parent ? world_matrix(world, transform.parent) : glm::mat4(1.0F);
}

void set_rotation(World& world, Entity entity, Transform transform, const glm::quat& rotation) {
    if (!is_finite(rotation)) return;
    transform.rotation = glm::normalize(rotation);
    world.set(entity, transform);
}

}  // namespace

Transform transform_of(const World& world, Entity entity) {
    const auto* present = world.find<Transform>(entity);
    return present != nullptr ? *present : Transform();
}

glm::vec3 position_of(const World& world, Entity entity) {
    return glm::vec3(world_matrix(world, entity)[3]);
}

void move_to(World& world, Entity entity, const glm::vec3& position) {
    Transform transform = transform_of(world, entity);
    const glm::vec3 local(glm::inverse(parent_matrix(world, transform)) * glm::vec4(position, 1.0F));
    if (!is_finite(local)) return;
    transform.translation = local;
    world.set(entity, transform);
}

void turn(World& world, Entity entity, const glm::quat& rotation) {
    const Transform transform = transform_of(world, entity);
    const glm::mat3 parent(parent_matrix(world, transform));
    const glm::mat3 turned = glm::inverse(parent) * glm::mat3_cast(rotation) * parent;
    const glm::vec3 x = glm::normalize(turned[0]);
    const glm::vec3 z = glm::normalize(glm::cross(x, turned[1]));
    const glm::quat local = glm::quat_cast(glm::mat3(x, glm::cross(z, x), z));
    set_rotation(world, entity, transform, local * transform.rotation);
}

void aim(World& world, Entity entity, const glm::vec3& direction) {
    const Transform transform = transform_of(world, entity);
    const glm::mat3 parent(parent_matrix(world, transform));
    const glm::vec3 wanted = glm::normalize(glm::inverse(parent) * direction);
    const glm::vec3 present = transform.rotation * glm::vec3(0.0F, 0.0F, -1.0F);
    if (!is_finite(wanted)) return;
    set_rotation(world, entity, transform, glm::quat(present, wanted) * transform.rotation);
}

glm::vec3 direction_of(const World& world, Entity entity) {
    const glm::vec3 direction = -glm::normalize(glm::vec3(world_matrix(world, entity)[2]));
    return is_finite(direction) ? direction : glm::vec3(0.0F, 0.0F, -1.0F);
}

std::vector<Entity> family_of(const World& world, Entity entity) {
    std::map<Entity, std::vector<Entity>> children;
    for (auto [child, transform] : world.view<Transform>()) {
        if (transform.parent && child != entity) children[transform.parent].push_back(child);
    }
    std::vector<Entity> family{entity};
    for (std::size_t i = 0; i < family.size(); ++i) {
        const std::vector<Entity> more = std::exchange(children[family[i]], {});
        family.insert(family.end(), more.begin(), more.end());
    }
    std::sort(family.begin(), family.end());
    return family;
}

}  // namespace candela::sandbox
