#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <candela/scene/components.hpp>
#include "sandbox/scene/scene.hpp"

namespace candela::sandbox {

/// A camera that orbits a pivot straight ahead of it. World space, metres; it looks along its -Z, with +Y up.
struct OrbitCamera {
    glm::vec3 eye{0.0F};
    glm::quat rotation{1.0F, 0.0F, 0.0F, 0.0F};
    float distance = 1.0F;  ///< from the eye to the pivot, > 0

    [[nodiscard]] glm::vec3 forward() const { return rotation * glm::vec3(0.0F, 0.0F, -1.0F); }
    [[nodiscard]] glm::vec3 pivot() const { return eye + distance * forward(); }
};

/// The orbit camera with the position and rotation of a camera matrix; its scale is ignored. The pivot is at
/// the depth of `target`, or at `least_distance` if the target is nearer than that or behind the camera.
[[nodiscard]] OrbitCamera look_from(const glm::mat4& world_from_camera, const glm::vec3& target,
                                    float least_distance);

/// Orbits around the pivot by angles in radians: `x` around the world's vertical, to the right; `y` upwards.
/// The camera stops before it reaches a pole.
[[nodiscard]] OrbitCamera orbited(const OrbitCamera& camera, glm::vec2 angles);

/// Looks around: like orbiting, but the eye stays in place and the pivot moves; `x` to the left, `y` up.
[[nodiscard]] OrbitCamera looked_around(const OrbitCamera& camera, glm::vec2 angles);

/// Moves eye and pivot along the axes of the view by metres, +x right, +y up, +z backwards.
[[nodiscard]] OrbitCamera moved(const OrbitCamera& camera, const glm::vec3& metres);

/// Multiplies the distance to the pivot by `factor`; the pivot stays in place.
[[nodiscard]] OrbitCamera zoomed(const OrbitCamera& camera, float factor);

/// Looks at a sphere from the same direction, from just far enough away that the picture (`aspect` is width /
/// height) shows all of it. `lens` becomes what shows it: the height of an orthographic camera, and planes
/// between which the sphere lies.
[[nodiscard]] OrbitCamera framed(const OrbitCamera& camera, const Bounds& sphere, float aspect, Camera& lens);

}  // namespace candela::sandbox
