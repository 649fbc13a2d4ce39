#include "engine/bvh/traverse.hpp"

#include <algorithm>
#include <limits>

#include <glm/geometric.hpp>

#include "engine/bvh/box.hpp"
#include "engine/bvh/bvh.hpp"

namespace candela {

std::optional<Hit> intersect(const Triangle& triangle, std::uint32_t index, const Ray& ray) {
    const glm::vec3 ab = triangle.b - triangle.a;
    const glm::vec3 ac = triangle.c - triangle.a;
    const glm::vec3 p = glm::cross(ray.direction, ac);
    const float determinant = glm::dot(ab, p);
    if (determinant == 0.0F) return std::nullopt;
    const glm::vec3 s = ray.origin - triangle.a;
    const glm::vec3 q = glm::cross(s, ab);
    const float inverse = 1.0F / determinant;
    const float u = glm::dot(s, p) * inverse;
    const float v = glm::dot(ray.direction, q) * inverse;
    if (!(u >= 0.0F && v >= 0.0F && u + v <= 1.0F)) return std::nullopt;

    // For a ray almost in the triangle's plane, rounding errors dominate the distance. Clamping it to the
    // triangle's box bounds that error and makes traversal exact: a ray that hits a triangle also enters all
    // boxes that contain the triangle, and not later than the hit.
    const Box box = bounds(triangle);
    const detail::Interval inside = detail::Slabs(ray)(box.lower, box.upper);
    if (inside.empty()) return std::nullopt;
    const float t = std::max(inside.near, std::min(inside.far, glm::dot(ac, q) * inverse));
    if (!(t > ray.t_min && t < ray.t_max)) return std::nullopt;
    return Hit{t, u, v, index};
}

std::optional<Hit> closest_hit(const Bvh& bvh, std::span<const Triangle> triangles, const Ray& ray) {
    std::optional<Hit> closest;
    float limit = ray.t_max;
    traverse(bvh, ray, [&](std::uint32_t index) {
        const auto hit = intersect(triangles[index], index, ray);
        const bool closer =
            hit && (hit->t < limit || (closest && hit->t == limit && index < closest->triangle));
        if (closer) {
            closest = hit;
            limit = hit->t;
        }
        return limit;
    });
    return closest;
}

bool any_hit(const Bvh& bvh, std::span<const Triangle> triangles, const Ray& ray) {
    bool found = false;
    traverse(bvh, ray, [&](std::uint32_t index) {
        found = found || intersect(triangles[index], index, ray).has_value();
        return found ? -std::numeric_limits<float>::infinity() : ray.t_max;
    });
    return found;
}

}  // namespace candela
