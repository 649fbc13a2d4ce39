#pragma once

#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include <candela/ecs/world.hpp>
#include <candela/scene/lights.hpp>
#include "sandbox/editing/history.hpp"

namespace candela::sandbox {

// Adding, copying and deleting. All of these are one edit of the history.

/// Whether the entity is a light of any kind.
[[nodiscard]] bool is_light(const World& world, Entity entity);
/// Whether the entity is a light that shines in a direction.
[[nodiscard]] bool has_direction(const World& world, Entity entity);
/// Whether it matters where the entity is. Only that of a light infinitely far away does not.
[[nodiscard]] bool has_place(const World& world, Entity entity);
/// Whether the entity has any component.
[[nodiscard]] bool is_present(const World& world, Entity entity);

/// `wanted` if no entity has this name; otherwise with the lowest number from 2 that makes it so: "lamp" and
/// "lamp 3" become "lamp 2" if there is a "lamp" and no "lamp 2".
[[nodiscard]] std::string unique_name(const World& world, const std::string& wanted);

/// Adds a light at a world-space position; if it has a direction, it shines along `direction` (length > 0).
/// It is as bright as the brightest light of its kind; the first of its kind lights a surface at the distance
/// `reach` (metres) with 2 lux.
Entity add_light(World& world, History& history, const AnyLight& light, const glm::vec3& position,
                 const glm::vec3& direction, float reach);

/// What the user is told that these are: the name of a single one, else for example "3 objects".
[[nodiscard]] std::string title_of(const World& world, std::span<const Entity> entities);

/// Those of the entities that are not below another one of them, in the same order.
[[nodiscard]] std::vector<Entity> roots_of(const World& world, std::span<const Entity> entities);

/// Copies entities, none of which is below another one, with everything below them, and moves the copies by
/// `offset` (metres, world space). Returns the copies of the entities.
std::vector<Entity> duplicate(World& world, History& history, std::span<const Entity> entities,
                              const glm::vec3& offset);
Entity duplicate(World& world, History& history, Entity entity, const glm::vec3& offset);

/// Removes the entities' components. One with children keeps its transform, so that they stay in place.
void remove(World& world, History& history, std::span<const Entity> entities);
void remove(World& world, History& history, Entity entity);

}  // namespace candela::sandbox
