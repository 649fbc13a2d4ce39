#include "sandbox/editing/orbit_camera.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/mat3x3.hpp>

namespace candela::sandbox {

namespace {

constexpr glm::vec3 vertical(0.0F, 1.0F, 0.0F);
constexpr glm::vec3 right(1.0F, 0.0F, 0.0F);
constexpr float steepest = 0.49F * glm::pi<float>();

/// Limits a turn so that the elevation stays within the allowed range, or within its present value if that is
/// outside.
float limited_turn(float elevation, float turn) {
    const float most = std::max(steepest, std::abs(elevation));
    return std::clamp(elevation + turn, -most, most) - elevation;
}

/// Half the width and height of the picture: in metres if orthographic, else 1 metre in front of the eye.
glm::vec2 half_extents(const Camera& lens, float aspect) {
    if (lens.projection == Camera::Projection::custom) {
        return {std::abs(1.0F / lens.matrix[0][0]), std::abs(1.0F / lens.matrix[1][1])};
    }
    const float height = is_orthographic(lens) ? lens.half_height : std::tan(lens.vertical_fov * 0.5F);
    return {height * aspect, height};
}

}  // namespace

OrbitCamera look_from(const glm::mat4& world_from_camera, const glm::vec3& target, float least_distance) {
    const glm::vec3 z = glm::normalize(glm::vec3(world_from_camera[2]));
    const glm::vec3 x = glm::normalize(glm::cross(glm::vec3(world_from_camera[1]), z));
    OrbitCamera camera{glm::vec3(world_from_camera[3]), glm::quat_cast(glm::mat3(x, glm::cross(z, x), z)),
                       1.0F};
    camera.distance = std::max(glm::dot(target - camera.eye, camera.forward()), least_distance);
    return camera;
}

OrbitCamera orbited(const OrbitCamera& camera, glm::vec2 angles) {
    const glm::vec3 pivot = camera.pivot();
    const float elevation = std::asin(std::clamp(-camera.forward().y, -1.0F, 1.0F));
    const glm::quat around = glm::angleAxis(angles.x, vertical);
    const glm::quat over = glm::angleAxis(-limited_turn(elevation, angles.y), right);
    OrbitCamera turned = camera;
    turned.rotation = glm::normalize(around * camera.rotation * over);
    turned.eye = pivot - turned.distance * turned.forward();
    return turned;
}

OrbitCamera looked_around(const OrbitCamera& camera, glm::vec2 angles) {
    const float elevation = std::asin(std::clamp(camera.forward().y, -1.0F, 1.0F));
    const glm::quat around = glm::angleAxis(angles.x, vertical);
    const glm::quat over = glm::angleAxis(limited_turn(elevation, angles.y), right);
    OrbitCamera turned = camera;
    turned.rotation = glm::normalize(around * camera.rotation * over);
    return turned;
}

OrbitCamera moved(const OrbitCamera& camera, const glm::vec3& metres) {
    OrbitCamera moved = camera;
    moved.eye += camera.rotation * metres;
    return moved;
}

OrbitCamera zoomed(const OrbitCamera& camera, float factor) {
    OrbitCamera moved = camera;
    moved.distance *= factor;
    moved.eye = camera.pivot() - moved.distance * moved.forward();
    return moved;
}

OrbitCamera framed(const OrbitCamera& camera, const Bounds& sphere, float aspect, Camera& lens) {
    constexpr float margin = 1.1F;
    const float radius = margin * sphere.radius;
    const glm::vec2 tangents = half_extents(lens, aspect);
    OrbitCamera found = camera;
    if (is_orthographic(lens)) {
        lens.half_height *= radius / std::min(tangents.x, tangents.y);
        found.distance = 2.0F * radius;
    } else {
        found.distance = radius / std::sin(std::atan(std::min(tangents.x, tangents.y)));
    }
    lens.near_plane = std::min(lens.near_plane, 0.5F * (found.distance - sphere.radius));
    lens.far_plane = std::max(lens.far_plane, found.distance + radius);
    found.eye = sphere.centre - found.distance * found.forward();
    return found;
}

}  // namespace candela::sandbox
