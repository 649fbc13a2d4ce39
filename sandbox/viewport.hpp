#pragma once

#include <optional>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/ecs/world.hpp"

namespace candela::sandbox {

/// Points from `origin` in a unit direction, world space, metres.
struct Ray {
    glm::vec3 origin{0.0F};
    glm::vec3 direction{0.0F, 0.0F, -1.0F};
};

/// Goes between the world and window coordinates, which run from the upper left corner.
struct Viewport {
    glm::mat4 clip_from_world{1.0F};
    glm::mat4 world_from_clip{1.0F};
    glm::vec3 forward{0.0F, 0.0F, -1.0F};  ///< unit vector, world space
    glm::vec2 size{1.0F};                  ///< window coordinates
};

/// The window as the camera fills it. Throws EntityError if the entity has no Camera.
[[nodiscard]] Viewport make_viewport(const World& world, Entity camera, glm::vec2 size);

/// Where a point of the world is seen; nothing if it lies behind the eye.
[[nodiscard]] std::optional<glm::vec2> project(const Viewport& viewport, const glm::vec3& point);

/// All points seen at a position, from the near plane on.
[[nodiscard]] Ray ray_through(const Viewport& viewport, glm::vec2 position);

/// Where the ray meets the plane through `point`; nothing if they are parallel or the plane lies behind.
[[nodiscard]] std::optional<glm::vec3> intersect_plane(const Ray& ray, const glm::vec3& point,
                                                       const glm::vec3& normal);

}  // namespace candela::sandbox
