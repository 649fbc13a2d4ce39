#include <candela/tools/ray.hpp>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

#include <candela/scene/components.hpp>
#include <candela/scene/hierarchy.hpp>
#include <candela/view.hpp>

namespace candela::tools {

Ray ray_through(const World& world, Entity camera, glm::vec2 size, glm::vec2 position) {
    const glm::mat4 pose = world_matrix(world, camera);
    const CameraView view = make_view(world.get<Camera>(camera), pose, glm::uvec2(size));
    return ray_through(glm::inverse(glm::dmat4(view.clip_from_world)), position / size);
}

Ray ray_through(const glm::dmat4& world_from_clip, glm::vec2 place) {
    const glm::vec2 ndc = glm::vec2(2.0F, -2.0F) * place + glm::vec2(-1.0F, 1.0F);
    // Depth is reversed: 1 on the near plane. A depth of 0.5 is beyond it, whatever the projection.
    const glm::dvec4 near = world_from_clip * glm::dvec4(ndc, 1.0, 1.0);
    const glm::dvec4 beyond = world_from_clip * glm::dvec4(ndc, 0.5, 1.0);
    const glm::dvec3 origin = glm::dvec3(near) / near.w;
    return {origin, glm::normalize(glm::dvec3(beyond) / beyond.w - origin)};
}

}  // namespace candela::tools
