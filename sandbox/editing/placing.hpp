#pragma once

#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include <candela/ecs/world.hpp>
#include <candela/scene/components.hpp>

namespace candela::sandbox {

// Entities placed in world space, whatever their parents are. All of these do nothing where the result would
// not be finite, such as below a parent that is scaled to zero.

/// The entity's transform; the identity if it has none.
[[nodiscard]] Transform transform_of(const World& world, Entity entity);

/// The entity's origin; world space, metres.
[[nodiscard]] glm::vec3 position_of(const World& world, Entity entity);

/// Moves the entity's origin to a world-space position.
void move_to(World& world, Entity entity, const glm::vec3& position);

/// Turns the entity around its origin by a rotation in world space. Below a parent whose scale differs
/// between axes, where a turn would also shear, the turn without the shear.
void turn(World& world, Entity entity, const glm::quat& rotation);

/// Turns the entity by the smallest angle so that its -Z points in a direction (world space, any length > 0).
void aim(World& world, Entity entity, const glm::vec3& direction);

/// The direction of the entity's -Z, unit length, world space; -Z where the entity's scale is zero.
[[nodiscard]] glm::vec3 direction_of(const World& world, Entity entity);

/// The entity and all that has it among its parents, ascending.
[[nodiscard]] std::vector<Entity> family_of(const World& world, Entity entity);

}  // namespace candela::sandbox
