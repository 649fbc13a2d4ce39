#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace candela::sandbox {

/// A viewpoint that turns around a pivot straight ahead. World space, metres; it looks along its -Z, +Y up.
struct OrbitCamera {
    glm::vec3 eye{0.0F};
    glm::quat rotation{1.0F, 0.0F, 0.0F, 0.0F};
    float distance = 1.0F;  ///< from the eye to the pivot, > 0

    [[nodiscard]] glm::vec3 forward() const { return rotation * glm::vec3(0.0F, 0.0F, -1.0F); }
    [[nodiscard]] glm::vec3 pivot() const { return eye + distance * forward(); }
};

/// The viewpoint of a camera's matrix, whose scale is left out, with its pivot at the depth of `target`, or
/// at `least_distance` if the target is nearer or behind.
[[nodiscard]] OrbitCamera look_from(const glm::mat4& world_from_camera, const glm::vec3& target,
                                    float least_distance);

/// Turns around the pivot by angles in radians: `x` around the world's vertical, to the right, `y` up over
/// it. It stops short of the poles.
[[nodiscard]] OrbitCamera orbited(const OrbitCamera& camera, glm::vec2 angles);

/// Moves eye and pivot by metres along the picture, +x right, +y up.
[[nodiscard]] OrbitCamera panned(const OrbitCamera& camera, glm::vec2 metres);

/// Multiplies the distance to the pivot, which stays.
[[nodiscard]] OrbitCamera zoomed(const OrbitCamera& camera, float factor);

}  // namespace candela::sandbox
