#pragma once

#include <glm/mat4x4.hpp>

#include "engine/ecs/world.hpp"
#include "engine/scene/components.hpp"
#include "engine/scene/scene_error.hpp"

namespace candela {

/// Local-to-parent matrix T·R·S of a transform, column vectors, metres.
[[nodiscard]] glm::mat4 local_matrix(const Transform& transform);

/// Local-to-world matrix of a live entity: the product of the local matrices from its topmost ancestor down.
/// An entity without a Transform sits in the world as it is. Linear in the entity's depth, which nothing
/// bounds. Throws SceneError that names the entity if an ancestor was destroyed or if the entity is its own
/// ancestor.
[[nodiscard]] glm::mat4 world_matrix(const World& world, Entity entity);

}  // namespace candela
