#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <candela/api.hpp>
#include <candela/ecs/world.hpp>

namespace candela::tools {

/// A ray from `origin` in a unit direction; world space, metres.
struct Ray {
    glm::vec3 origin{0.0F};
    glm::vec3 direction{0.0F, 0.0F, -1.0F};
};

/// The ray of all points that a camera sees at a position of its picture, starting on the near plane. `size`
/// and `position` are in pixels; (0, 0) is the upper left corner of the picture, and (0.5, 0.5) the centre of
/// its first pixel. Both components of `size` are >= 1. Throws EntityError if the entity has no Camera.
[[nodiscard]] CANDELA_API Ray ray_through(const World& world, Entity camera, glm::vec2 size,
                                          glm::vec2 position);

/// The same for the inverse of CameraView::clip_from_world. `place` is (0, 0) in the upper left corner of the
/// picture and (1, 1) in the lower right one. The matrix is of double precision, because the near plane may
/// be a thousandth of the distances of interest.
[[nodiscard]] CANDELA_API Ray ray_through(const glm::dmat4& world_from_clip, glm::vec2 place);

}  // namespace candela::tools
