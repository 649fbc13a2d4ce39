#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include <glm/geometric.hpp>

#include "engine/bvh/box.hpp"
#include "engine/bvh/bvh.hpp"

namespace candela {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

// Relative margin of a box's interval on the ray. Rounding needs 4e-7 (Ize, "Robust BVH Ray Traversal",
// 2013); division on a GPU, with an error of up to 2.5 units in the last place, needs about as much in
// addition.
constexpr float slack = 1.00001F;

struct Interval {
    float near;
    float far;

    [[nodiscard]] bool empty() const { return !(near <= far * slack); }
};

// The part of the ray in a box, by slabs (Kay and Kajiya, "Ray Tracing Complex Scenes", 1986). Per axis,
//     enter = (plane met first - origin) / direction,  exit = (the other plane - origin) / direction,
// and near and far are the latest entry and the earliest exit. Where direction is 0, IEEE division makes them
// -∞ or +∞, depending on whether the origin is between the planes. An origin on a plane gives 0 · ∞ = NaN:
// the comparisons are written so that NaN does not restrict the interval. Every step is monotonic, so the
// interval in a box contains the interval in each box inside it, also with rounding.
class Slabs {
 public:
    explicit Slabs(const Ray& ray)
        : origin_(ray.origin), inverse_(1.0F / ray.direction), whole_{ray.t_min, ray.t_max} {}

    [[nodiscard]] Interval operator()(const glm::vec3& lower, const glm::vec3& upper) const {
        Interval inside = whole_;
        for (glm::length_t axis = 0; axis < 3; ++axis) {
            const float to_lower = (lower[axis] - origin_[axis]) * inverse_[axis];
            const float to_upper = (upper[axis] - origin_[axis]) * inverse_[axis];
            const bool forwards = inverse_[axis] >= 0.0F;
            const float enter = forwards ? to_lower : to_upper;
            const float exit = forwards ? to_upper : to_lower;
            inside.near = enter > inside.near ? enter : inside.near;
            inside.far = exit < inside.far ? exit : inside.far;
        }
        return inside;
    }

 private:
    glm::vec3 origin_;
    glm::vec3 inverse_;
    Interval whole_;
};

// A node to visit, and the distance at which the ray enters it; +∞ if it misses the node.
struct Entry {
    std::uint32_t node;
    float near;
};

Entry enter(const Bvh& bvh, std::uint32_t node, const Slabs& slabs) {
    const Interval inside = slabs(bvh.nodes[node].lower, bvh.nodes[node].upper);
    return {node, inside.empty() ? infinity : inside.near};
}

// Calls `visit(triangle)` for each triangle that the ray may hit, roughly from near to far. `visit` returns
// the distance beyond which triangles can be skipped.
template <class Visit>
void traverse(const Bvh& bvh, const Ray& ray, Visit&& visit) {
    if (bvh.nodes.empty()) {
        return;
    }
    const Slabs slabs(ray);
    float limit = std::min(ray.t_max, std::numeric_limits<float>::max());  // finite, so that it excludes +∞
    // Each inner node on the way down puts at most its farther child on the stack, and there are at most
    // `bvh_max_depth` inner nodes above a leaf.
    std::array<Entry, bvh_max_depth> stack{};
    std::size_t waiting = 0;
    Entry current = enter(bvh, 0, slabs);
    while (true) {
        const BvhNode& node = bvh.nodes[current.node];
        if (current.near <= limit && node.count == 0) {
            Entry nearer = enter(bvh, node.first, slabs);
            Entry farther = enter(bvh, node.first + 1, slabs);
            if (farther.near < nearer.near) {
                std::swap(nearer, farther);
            }
            if (farther.near <= limit) {
                stack[waiting++] = farther;
            }
            current = nearer;
            continue;
        }
        for (std::uint32_t i = 0; i < node.count && current.near <= limit; ++i) {
            limit = std::min(limit, visit(bvh.order[node.first + i]));
        }
        if (waiting == 0) {
            return;
        }
        current = stack[--waiting];
    }
}

}  // namespace

std::optional<Hit> intersect(const Triangle& triangle, std::uint32_t index, const Ray& ray) {
    const glm::vec3 ab = triangle.b - triangle.a;
    const glm::vec3 ac = triangle.c - triangle.a;
    const glm::vec3 p = glm::cross(ray.direction, ac);
    const float determinant = glm::dot(ab, p);
    if (determinant == 0.0F) {
        return std::nullopt;
    }
    const glm::vec3 s = ray.origin - triangle.a;
    const glm::vec3 q = glm::cross(s, ab);
    const float inverse = 1.0F / determinant;
    const float u = glm::dot(s, p) * inverse;
    const float v = glm::dot(ray.direction, q) * inverse;
    if (!(u >= 0.0F && v >= 0.0F && u + v <= 1.0F)) {
        return std::nullopt;
    }

    // For a ray almost in the triangle's plane, rounding errors dominate the distance. Clamping it to the
    // triangle's box bounds that error and makes traversal exact: a ray that hits a triangle also enters all
    // boxes that contain the triangle, and not later than the hit.
    const Box box = bounds(triangle);
    const Interval inside = Slabs(ray)(box.lower, box.upper);
    if (inside.empty()) {
        return std::nullopt;
    }
    const float t = std::max(inside.near, std::min(inside.far, glm::dot(ac, q) * inverse));
    if (!(t > ray.t_min && t < ray.t_max)) {
        return std::nullopt;
    }
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
        return found ? -infinity : ray.t_max;
    });
    return found;
}

}  // namespace candela
