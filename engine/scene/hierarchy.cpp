#include <candela/scene/hierarchy.hpp>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "engine/readable.hpp"

namespace candela {

glm::mat4 local_matrix(const Transform& transform) {
    const glm::mat4 translation = glm::translate(glm::mat4(1.0F), transform.translation);
    return glm::scale(translation * glm::mat4_cast(transform.rotation), transform.scale);
}

std::string describe(const WorldReader& world, Entity entity) {
    const Name* name = world.for_messages().find<Name>(entity);
    return name ? fmt::format("entity \"{}\"", readable(name->value))
                : fmt::format("entity {}", entity.index);
}

glm::mat4 world_matrix(const WorldReader& world, Entity entity) {
    return WorldMatrices(world)(entity);
}

glm::mat4 WorldMatrices::operator()(Entity entity) {
    const auto* const transform = world_.find<Transform>(entity);
    if (!transform) return glm::mat4(1.0F);
    const glm::mat4 local = local_matrix(*transform);
    return transform->parent ? of_parent(entity, *transform) * local : local;
}

/// Goes up to an ancestor whose matrix is known, or to the topmost one, and down again. `transform`: the
/// entity's.
glm::mat4 WorldMatrices::of_parent(Entity entity, const Transform& transform) {
    ahead_.clear();
    glm::mat4 matrix(1.0F);
    Entity child = entity;
    for (const Transform* at = &transform; at && at->parent; at = world_.find<Transform>(child)) {
        if (!world_.alive(at->parent)) {
            throw SceneError(fmt::format("{}: its parent no longer exists", describe(world_, child)));
        }
        if (const auto known = parents_.find(at->parent.index); known != parents_.end()) {
            matrix = known->second;
            break;
        }
        if (ahead_.size() == world_.count<Transform>()) {
            throw SceneError(fmt::format("{}: its parents form a cycle", describe(world_, entity)));
        }
        child = at->parent;
        ahead_.push_back(child);
    }
    for (; !ahead_.empty(); ahead_.pop_back()) {
        if (const auto* const ancestor = world_.find<Transform>(ahead_.back())) {
            matrix = matrix * local_matrix(*ancestor);
        }
        parents_.emplace(ahead_.back().index, matrix);
    }
    return matrix;
}

}  // namespace candela
