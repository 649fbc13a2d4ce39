#include "sandbox/editing/viewport.hpp"

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

#include <candela/scene/components.hpp>
#include <candela/scene/hierarchy.hpp>
#include <candela/view.hpp>

namespace candela::sandbox {

Viewport make_viewport(const World& world, Entity camera, glm::vec2 size, glm::vec2 origin) {
    const glm::mat4 pose = world_matrix(world, camera);
    const CameraView view = make_view(world.get<Camera>(camera), pose, glm::uvec2(size));
    return {view.clip_from_world, glm::inverse(glm::dmat4(view.clip_from_world)),
            -glm::normalize(glm::vec3(pose[2])), size, origin};
}

std::optional<glm::vec2> project(const Viewport& viewport, const glm::vec3& point) {
    const glm::vec4 clip = viewport.clip_from_world * glm::vec4(point, 1.0F);
    if (clip.w <= 0.0F) return std::nullopt;
    const glm::vec2 ndc = glm::vec2(clip) / clip.w;
    return glm::vec2(0.5F + 0.5F * ndc.x, 0.5F - 0.5F * ndc.y) * viewport.size + viewport.origin;
}

float metres_per_unit(const Viewport& viewport, const glm::vec3& point) {
    // The rows of clip space give y = (a·p) / (w·p): a metre upwards at the point changes y by |a| / w.
    const glm::mat4& clip = viewport.clip_from_world;
    const float w = (clip * glm::vec4(point, 1.0F)).w;
    const float scale = glm::length(glm::vec3(clip[0][1], clip[1][1], clip[2][1]));
    return 2.0F * w / (scale * viewport.size.y);
}

tools::Ray ray_through(const Viewport& viewport, glm::vec2 position) {
    return tools::ray_through(viewport.world_from_clip, (position - viewport.origin) / viewport.size);
}

std::optional<glm::vec3> intersect_plane(const tools::Ray& ray, const glm::vec3& point,
                                         const glm::vec3& normal) {
    constexpr float least_cosine = 1e-4F;
    const float cosine = glm::dot(ray.direction, normal);
    if (std::abs(cosine) < least_cosine) return std::nullopt;
    const float distance = glm::dot(point - ray.origin, normal) / cosine;
    if (distance < 0.0F) return std::nullopt;
    return ray.origin + distance * ray.direction;
}

}  // namespace candela::sandbox
