#include <candela/scene/hierarchy.hpp>

#include <cstddef>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

namespace candela {

glm::mat4 local_matrix(const Transform& transform) {
    const glm::mat4 translation = glm::translate(glm::mat4(1.0F), transform.translation);
    return glm::scale(translation * glm::mat4_cast(transform.rotation), transform.scale);
}

std::string describe(const World& world, Entity entity) {
    const Name* name = world.find<Name>(entity);
    return name ? fmt::format("entity \"{}\"", name->value) : fmt::format("entity {}", entity.index);
}

glm::mat4 world_matrix(const World& world, Entity entity) {
    glm::mat4 matrix(1.0F);
    const auto deepest = world.count<Transform>();
    Entity at = entity;
    for (std::size_t depth = 0;; ++depth) {
        const auto* transform = world.find<Transform>(at);
        if (!transform) {
            return matrix;
        }
        if (depth == deepest) {
            throw SceneError(fmt::format("{}: its parents form a cycle", describe(world, entity)));
        }
        matrix = local_matrix(*transform) * matrix;
        if (!transform->parent) {
            return matrix;
        }
        if (!world.alive(transform->parent)) {
            throw SceneError(fmt::format("{}: its parent no longer exists", describe(world, at)));
        }
        at = transform->parent;
    }
}

}  // namespace candela
