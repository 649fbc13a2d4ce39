#include "sandbox/editing/drag.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <candela/scene/hierarchy.hpp>
#include "sandbox/candela_private.hpp"
#include "sandbox/editing/placing.hpp"
#include "sandbox/scene/scene.hpp"

namespace candela::sandbox {

namespace {

/// Of the angle between an axis and the view: below that, a small motion of the pointer would be a large one
/// along the axis.
constexpr float least_sine = 0.03F;

/// The position along the line `origin` + t·`axis` (unit length) that is nearest to the ray, in metres;
/// nullopt if the ray is almost parallel to the line, or if it points away from the nearest position.
std::optional<float> nearest_on_line(const tools::Ray& ray, const glm::vec3& origin, const glm::vec3& axis) {
    const float cosine = glm::dot(axis, ray.direction);
    const float squared_sine = 1.0F - cosine * cosine;
    if (!(squared_sine > least_sine * least_sine)) return std::nullopt;
    const glm::vec3 between = origin - ray.origin;
    const float along_axis = glm::dot(between, axis);
    const float along_ray = glm::dot(between, ray.direction);
    if (along_ray - cosine * along_axis < 0.0F) return std::nullopt;
    return (cosine * along_ray - along_axis) / squared_sine;
}

/// The angle from `from` to `to` around the axis, radians, all of any length.
float angle_around(const glm::vec3& axis, const glm::vec3& from, const glm::vec3& to) {
    return std::atan2(glm::dot(axis, glm::cross(from, to)), glm::dot(from, to));
}

}  // namespace

glm::vec3 axis_of(const World& world, Entity entity, DragMode mode) {
    const glm::length_t axis = mode.axis;
    glm::vec3 direction(0.0F);
    direction[axis] = 1.0F;
    if (mode.kind != DragKind::scale_along_axis) return direction;
    direction = glm::vec3(world_matrix(world, entity)[axis]);
    const float length = glm::length(direction);
    return std::isnormal(length) ? direction / length : glm::vec3(0.0F);
}

Drag::Drag(const World& world, const Viewport& viewport, Entity entity, DragMode mode,
           const glm::vec3& centre, glm::vec2 pointer)
    : entity_(entity),
      mode_(mode),
      centre_(centre),
      axis_(axis_of(world, entity, mode)),
      forward_(viewport.forward),
      grabbed_(ray_through(viewport, pointer)),
      pointer_(pointer),
      family_(family_of(world, entity)) {
    if (world.has<Transform>(entity)) start_ = world.get<Transform>(entity);
    const Box box = box_of(world, family_);
    if (box.lower.x > box.upper.x) return;
    for (unsigned corner = 0; corner < 8; ++corner) corners_.push_back(box.corner(corner));
}

void Drag::set_mode(World& world, DragMode mode) {
    if (start_) {
        world.set(entity_, *start_);
    } else {
        world.remove<Transform>(entity_);
    }
    mode_ = mode;
    axis_ = axis_of(world, entity_, mode);
}

void Drag::follow(World& world, const Viewport& viewport, glm::vec2 pointer, const tools::SceneRays& surfaces,
                  float gap) const {
    const tools::Ray ray = ray_through(viewport, pointer);
    switch (mode_.kind) {
        case DragKind::move_in_plane:
            return move_in_plane(world, ray);
        case DragKind::move_along_axis:
            return move_along_axis(world, ray);
        case DragKind::move_over_surface:
            return move_over_surface(world, ray, surfaces, gap);
        case DragKind::turn_around_axis:
            return turn_around(world, ray, axis_);
        case DragKind::turn_around_view:
            return turn_around(world, ray, forward_);
        case DragKind::aim:
            return aim_at(world, ray, surfaces);
        case DragKind::scale: {
            // To the right or up by this many window coordinates doubles the size.
            constexpr float doubles = 100.0F;
            const glm::vec2 moved = glm::vec2(1.0F, -1.0F) * (pointer - pointer_);
            return scale_by(world, glm::vec3(std::exp2((moved.x + moved.y) / doubles)));
        }
        case DragKind::scale_along_axis:
            return scale_along_axis(world, ray);
    }
}

void Drag::move_in_plane(World& world, const tools::Ray& ray) const {
    const auto from = intersect_plane(grabbed_, centre_, forward_);
    const auto to = intersect_plane(ray, centre_, forward_);
    if (from && to) move_to(world, entity_, centre_ + *to - *from);
}

void Drag::move_along_axis(World& world, const tools::Ray& ray) const {
    const auto from = nearest_on_line(grabbed_, centre_, axis_);
    const auto to = nearest_on_line(ray, centre_, axis_);
    if (from && to) move_to(world, entity_, centre_ + (*to - *from) * axis_);
}

/// Meshes rest on the surface, everything else keeps the gap.
void Drag::move_over_surface(World& world, const tools::Ray& ray, const tools::SceneRays& surfaces,
                             float gap) const {
    const std::optional<tools::SurfaceHit> hit = surfaces.first_hit(ray, family_);
    if (!hit) return;
    float above = corners_.empty() ? gap : -std::numeric_limits<float>::infinity();
    for (const glm::vec3& corner : corners_) above = std::max(above, glm::dot(centre_ - corner, hit->normal));
    move_to(world, entity_, hit->point + above * hit->normal);
}

void Drag::turn_around(World& world, const tools::Ray& ray, const glm::vec3& axis) const {
    const bool edge_on = std::abs(glm::dot(axis, ray.direction)) < least_sine ||
                         std::abs(glm::dot(axis, grabbed_.direction)) < least_sine;
    const auto from = intersect_plane(grabbed_, centre_, axis);
    const auto to = intersect_plane(ray, centre_, axis);
    if (edge_on || !from || !to) return;
    const float angle = angle_around(axis, *from - centre_, *to - centre_);
    world.set(entity_, start_.value_or(Transform()));
    turn(world, entity_, glm::angleAxis(angle, axis));
}

/// Where there is no surface, at the point as far away as the entity.
void Drag::aim_at(World& world, const tools::Ray& ray, const tools::SceneRays& surfaces) const {
    const std::optional<tools::SurfaceHit> hit = surfaces.first_hit(ray, family_);
    const glm::vec3 target =
        hit ? hit->point : ray.origin + glm::distance(ray.origin, centre_) * ray.direction;
    if (glm::distance(target, centre_) > 0.0F) aim(world, entity_, target - centre_);
}

void Drag::scale_by(World& world, const glm::vec3& factors) const {
    constexpr float most = 1000.0F;  // in one drag
    Transform transform = start_.value_or(Transform());
    transform.scale *= glm::clamp(factors, 1.0F / most, most);
    const glm::vec3& scale = transform.scale;
    if (std::isnormal(scale.x) && std::isnormal(scale.y) && std::isnormal(scale.z)) {
        world.set(entity_, transform);
    }
}

void Drag::scale_along_axis(World& world, const tools::Ray& ray) const {
    const auto from = nearest_on_line(grabbed_, centre_, axis_);
    const auto to = nearest_on_line(ray, centre_, axis_);
    if (!from || !to || !std::isfinite(*to / *from)) return;
    glm::vec3 factors(1.0F);
    factors[mode_.axis] = *to / *from;
    scale_by(world, factors);
}

}  // namespace candela::sandbox
