#include "renderer/tools/reference/camera.hpp"

#include <cmath>

#include <glm/geometric.hpp>

namespace candela::reference {

Viewpoint::Viewpoint(const Camera& camera, const glm::mat4& to_world, glm::uvec2 size)
    : camera_(camera), size_(size), eye_(to_world[3]) {
    forward_ = -glm::normalize(glm::dvec3(to_world[2]));
    right_ = glm::normalize(glm::cross(forward_, glm::dvec3(to_world[1])));
    up_ = glm::cross(right_, forward_);
    const bool perspective = camera.projection == Camera::Projection::perspective;
    half_height_ = perspective ? std::tan(static_cast<double>(camera.vertical_fov) / 2.0)
                               : static_cast<double>(camera.half_height);
}

Ray Viewpoint::through(glm::dvec2 point) const {
    const glm::dvec2 at = point / size_ * 2.0 - 1.0;
    const glm::dvec3 aside = half_height_ * (at.x * size_.x / size_.y * right_ - at.y * up_);
    Ray ray{.origin = {}, .direction = {}, .nearest = camera_.near_plane, .farthest = camera_.far_plane};
    if (camera_.projection == Camera::Projection::perspective) {
        ray.origin = eye_;
        ray.direction = forward_ + aside;
    } else {
        ray.origin = eye_ + aside;
        ray.direction = forward_;
    }
    return ray;
}

}  // namespace candela::reference
