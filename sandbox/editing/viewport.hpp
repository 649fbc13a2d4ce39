#pragma once

#include <optional>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <candela/ecs/world.hpp>
#include <candela/tools/ray.hpp>

namespace candela::sandbox {

/// Converts between world space and window coordinates, whose origin is the window's upper left corner. The
/// picture fills a rectangle of the window.
struct Viewport {
    glm::mat4 clip_from_world{1.0F};
    glm::dmat4 world_from_clip{1.0};       ///< of double precision for tools::ray_through
    glm::vec3 forward{0.0F, 0.0F, -1.0F};  ///< unit vector, world space
    glm::vec2 size{1.0F};                  ///< of the picture, window coordinates
    glm::vec2 origin{0.0F};                ///< upper left corner of the picture, window coordinates

    [[nodiscard]] bool contains(glm::vec2 position) const {
        const glm::vec2 inside = position - origin;
        return inside.x >= 0.0F && inside.y >= 0.0F && inside.x < size.x && inside.y < size.y;
    }
};

/// The viewport of a camera whose picture has this size and upper left corner in the window; both components
/// of the size are >= 1. Throws EntityError if the entity has no Camera.
[[nodiscard]] Viewport make_viewport(const World& world, Entity camera, glm::vec2 size,
                                     glm::vec2 origin = glm::vec2(0.0F));

/// The window position of a world-space point; nullopt if it is behind the eye.
[[nodiscard]] std::optional<glm::vec2> project(const Viewport& viewport, const glm::vec3& point);

/// World-space metres per window coordinate at the depth of a point in front of the eye.
[[nodiscard]] float metres_per_unit(const Viewport& viewport, const glm::vec3& point);

/// The ray of all points seen at a window position, starting on the near plane.
[[nodiscard]] tools::Ray ray_through(const Viewport& viewport, glm::vec2 position);

/// The intersection of the ray with the plane through `point`; nullopt if they are parallel or the plane is
/// behind the origin of the ray.
[[nodiscard]] std::optional<glm::vec3> intersect_plane(const tools::Ray& ray, const glm::vec3& point,
                                                       const glm::vec3& normal);

}  // namespace candela::sandbox
