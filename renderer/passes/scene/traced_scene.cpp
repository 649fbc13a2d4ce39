#include "renderer/passes/scene/traced_scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "engine/bvh/traverse.hpp"
#include "renderer/passes/scene/world_triangles.hpp"

namespace candela {
namespace {

/// Normal of the front, twice as long as the triangle's area.
glm::vec3 cross_of(const Triangle& triangle) {
    return glm::cross(triangle.b - triangle.a, triangle.c - triangle.a);
}

/// The ray in the space of an object's mesh. The distance along it is the same there.
Ray ray_in(const SceneObject& object, const Ray& ray) {
    return {glm::vec3(object.mesh_from_world * glm::vec4(ray.origin, 1.0F)),
            glm::mat3(object.mesh_from_world) * ray.direction, ray.t_min, ray.t_max};
}

/// Calls `found(hit, triangle, object)` for surfaces that the ray meets, roughly from near to far. It returns
/// the distance beyond which others can be skipped.
template <class Found>
void trace(const TracedScene& scene, const Ray& ray, Found&& found) {
    float limit = ray.t_max;
    traverse(scene.hierarchy.top.tree(), ray, [&](std::uint32_t i) {
        const SceneObject& object = *scene.hierarchy.objects[i];
        const PlacedMesh mesh = object.mesh->placed();
        const Ray local = ray_in(object, ray);
        traverse(object.mesh->bvh, local, [&](std::uint32_t index) {
            const auto hit = intersect(mesh.triangle(index), index, local);
            if (!hit || hit->t >= limit || is_hole(mesh, index, {hit->u, hit->v})) return limit;
            const PlacedMesh placed =
                placed_in_world(scene.layout, scene.layout.drawables[i], scene.placement);
            limit = found(*hit, placed.triangle(index), i);
            return limit;
        });
        return limit;
    });
}

}  // namespace

std::optional<SurfaceHit> nearest_surface(const TracedScene& scene, const Ray& ray) {
    std::optional<float> nearest;
    Triangle hit_triangle{};
    trace(scene, ray, [&](const Hit& hit, const Triangle& triangle, std::uint32_t) {
        nearest = hit.t;
        hit_triangle = triangle;
        return hit.t;
    });
    if (!nearest) return std::nullopt;
    const glm::vec3 cross = cross_of(hit_triangle);
    const glm::vec3 normal = glm::normalize(cross);
    return SurfaceHit{*nearest, ray.origin + *nearest * ray.direction,
                      glm::dot(cross, ray.direction) < 0.0F ? normal : -normal};
}

std::vector<std::uint32_t> order_of_solids(const SceneLayout& layout) {
    std::vector<std::uint32_t> order(layout.drawables.size());
    std::uint32_t count = 0;
    layout.visit_solids([&](std::uint32_t number) { order[number] = count++; });
    return order;
}

bool is_covered(const TracedScene& scene, std::span<const std::uint32_t> order, const LayerPoint& point,
                const LayerLimits& limits) {
    const Ray down{point.position + limits.reach * point.normal, -point.normal, 0.0F,
                   limits.reach + limits.tie};
    bool covered = false;
    trace(scene, down, [&](const Hit& hit, const Triangle& triangle, std::uint32_t object) {
        const bool double_sided = scene.layout.drawables[object].primitive().material->double_sided;
        const bool faces_along = double_sided || glm::dot(cross_of(triangle), point.normal) > 0.0F;
        const bool is_in_front = limits.reach - hit.t > limits.tie;
        const bool comes_first =
            std::pair(order[object], hit.triangle) < std::pair(point.solid, point.triangle);
        covered = faces_along && (is_in_front || comes_first);
        return covered ? -1.0F : down.t_max;
    });
    return covered;
}

bool is_blocked(const TracedScene& scene, const glm::vec3& from, const glm::vec3& to) {
    bool blocked = false;
    trace(scene, {from, to - from, 0.0F, 1.0F}, [&](const Hit&, const Triangle&, std::uint32_t) {
        blocked = true;
        return -1.0F;  // nothing else matters
    });
    return blocked;
}

}  // namespace candela
