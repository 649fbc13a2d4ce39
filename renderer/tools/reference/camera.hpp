#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include <candela/scene/components.hpp>
#include "renderer/tools/reference/geometry.hpp"

namespace candela::reference {

/// The rays of a camera. Its pose has no scale: it looks along its -Z, and its up vector is its +Y, made
/// perpendicular to that.
class Viewpoint {
 public:
    Viewpoint(const Camera& camera, const glm::mat4& to_world, glm::uvec2 size);

    /// The ray through a point of the picture, in pixels from its top left corner, from the near plane to the
    /// far plane. Distances along the ray are depths in metres.
    [[nodiscard]] Ray through(glm::dvec2 point) const;

 private:
    Camera camera_;
    glm::dvec2 size_;
    glm::dvec3 eye_;
    glm::dvec3 right_, up_, forward_;
    double half_height_;  ///< of the view; perspective: at unit depth
};

}  // namespace candela::reference
