#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <random>
#include <span>
#include <vector>

#include <doctest/doctest.h>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include "engine/bvh/box.hpp"
#include "engine/bvh/bvh.hpp"
#include "engine/bvh/traverse.hpp"
#include "engine/bvh/wide.hpp"

/// What tests of hierarchies have in common: random triangles, and rays against all of them.
namespace candela::test {

using Triangles = std::vector<Triangle>;

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

class Random {
 public:
    explicit Random(std::uint32_t seed) : engine_(seed) {}

    float number(float lower, float upper) {
        return std::uniform_real_distribution<float>(lower, upper)(engine_);
    }
    glm::vec3 point(float reach) {
        const float x = number(-reach, reach);
        const float y = number(-reach, reach);
        return {x, y, number(-reach, reach)};
    }

 private:
    std::mt19937 engine_;
};

inline Triangle triangle_near(const glm::vec3& centre, float reach, Random& random) {
    const glm::vec3 a = centre + random.point(reach);
    const glm::vec3 b = centre + random.point(reach);
    return {a, b, centre + random.point(reach)};
}

// Triangles of about `reach` metres, scattered in a cube of edge 2 m around the origin.
inline Triangles soup(std::size_t n, float reach, Random& random) {
    Triangles triangles;
    for (std::size_t i = 0; i < n; ++i) {
        triangles.push_back(triangle_near(random.point(1.0F), reach, random));
    }
    return triangles;
}

// Small triangles, of every third of which a vertex, or all of them, are NaN or infinite.
inline Triangles soup_with_bad_vertices(Random& random) {
    Triangles triangles = soup(200, 0.2F, random);
    for (std::size_t i = 0; i < triangles.size(); i += 3) {
        triangles[i].b.y = i % 2 == 0 ? not_a_number : infinity;
        if (i % 4 == 0)
            triangles[i] = {glm::vec3(not_a_number), glm::vec3(not_a_number), glm::vec3(not_a_number)};
    }
    return triangles;
}

inline Ray ray_through(Random& random) {
    const glm::vec3 origin = random.point(1.5F);
    return {origin, random.point(1.0F) - origin};
}

// Tests every triangle, without the hierarchy.
inline std::optional<Hit> brute_force(std::span<const Triangle> triangles, const Ray& ray) {
    std::optional<Hit> closest;
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        const auto hit = intersect(triangles[i], i, ray);
        if (hit && (!closest || hit->t < closest->t)) closest = hit;
    }
    return closest;
}

inline bool same(const std::optional<Hit>& a, const std::optional<Hit>& b) {
    if (!a || !b) return a.has_value() == b.has_value();
    return a->triangle == b->triangle && a->t == b->t && a->u == b->u && a->v == b->v;
}

/// Wide nodes, whose leaves are entries of `order`.
struct Wide {
    std::vector<WideNode> nodes;
    std::vector<std::uint32_t> order;
};

/// The box of a child, as shaders compute it.
inline Box child_box(const WideNode& node, std::uint32_t child) {
    const auto along = [&](glm::length_t axis, const glm::uvec3& steps) {
        const std::uint32_t exponent = node.exponents >> static_cast<unsigned>(8 * axis) & 255U;
        const float step = exponent == 0 ? 0.0F : std::ldexp(1.0F, static_cast<int>(exponent) - 127);
        return node.origin[axis] + step * static_cast<float>(steps[axis] >> 8U * child & 255U);
    };
    return {{along(0, node.lower), along(1, node.lower), along(2, node.lower)},
            {along(0, node.upper), along(1, node.upper), along(2, node.upper)}};
}

/// Calls `visit(i, box)` for the entries of `order` in all boxes that `enters(box)`, with the box of their
/// leaf.
template <class Enters, class Visit>
void traverse_wide(const Wide& wide, Enters enters, Visit visit) {
    struct Waiting {
        std::uint32_t word;
        Box box;
    };
    std::vector<Waiting> waiting{{0, {}}};
    std::size_t most = 1;
    while (!waiting.empty()) {
        const auto [word, box] = waiting.back();
        waiting.pop_back();
        const std::uint32_t first = word >> 3U;
        const std::uint32_t count = word & 7U;
        if (count == instance_child) {  // of a mesh in world space
            waiting.push_back({wide.nodes.at(first).children.x, box});
            continue;
        }
        for (std::uint32_t i = first; i < first + count; ++i) {
            visit(wide.order.at(i), box);
        }
        if (count > 0) continue;
        const WideNode& node = wide.nodes.at(first);
        for (std::uint32_t child = 0; child < 4; ++child) {
            const std::uint32_t below = node.children[static_cast<glm::length_t>(child)];
            const Box around = child_box(node, child);
            if (below != 0 && enters(around)) waiting.push_back({below, around});
        }
        most = std::max(most, waiting.size());
    }
    REQUIRE(most <= wide_stack_size);
}

inline std::optional<Hit> closest_hit(const Wide& wide, std::span<const Triangle> triangles, const Ray& ray) {
    std::optional<Hit> closest;
    const detail::Slabs slabs(ray);
    traverse_wide(
        wide, [&](const Box& box) { return !slabs(box.lower, box.upper).empty(); },
        [&](std::uint32_t i, const Box&) {
            const auto hit = intersect(triangles[i], i, ray);
            const bool closer = hit && (!closest || hit->t < closest->t ||
                                        (hit->t == closest->t && hit->triangle < closest->triangle));
            if (closer) closest = hit;
        });
    return closest;
}

inline bool any_hit(const Wide& wide, std::span<const Triangle> triangles, const Ray& ray) {
    return closest_hit(wide, triangles, ray).has_value();
}

template <class Hierarchy>
bool agrees_with_brute_force(const Hierarchy& bvh, std::span<const Triangle> triangles, const Ray& ray) {
    const auto expected = brute_force(triangles, ray);
    return same(closest_hit(bvh, triangles, ray), expected) &&
           any_hit(bvh, triangles, ray) == expected.has_value();
}

template <class Hierarchy>
std::size_t disagreements(const Hierarchy& bvh, std::span<const Triangle> triangles, std::size_t rays,
                          Random& random) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < rays; ++i) {
        count += agrees_with_brute_force(bvh, triangles, ray_through(random)) ? 0 : 1;
    }
    return count;
}

inline bool contains(const BvhNode& node, const glm::vec3& lower, const glm::vec3& upper) {
    return glm::all(glm::lessThanEqual(node.lower, lower)) &&
           glm::all(glm::greaterThanEqual(node.upper, upper));
}

inline bool contains(const BvhNode& node, const Triangle& triangle) {
    return contains(node, glm::min(triangle.a, glm::min(triangle.b, triangle.c)),
                    glm::max(triangle.a, glm::max(triangle.b, triangle.c)));
}

// Number of the node's triangles or children that are not in its box.
inline std::size_t count_escaped(const Bvh& bvh, const BvhNode& node, std::span<const Triangle> triangles) {
    std::size_t escaped = 0;
    for (std::uint32_t i = 0; i < node.count; ++i) {
        escaped += contains(node, triangles[bvh.order[node.first + i]]) ? 0 : 1;
    }
    if (node.count > 0) return escaped;
    for (const std::uint32_t child : {node.first, node.first + 1}) {
        escaped += contains(node, bvh.nodes[child].lower, bvh.nodes[child].upper) ? 0 : 1;
    }
    return escaped;
}

// Triangles with edge lengths and distances of 2^lowest ... 2^highest m along each axis, `copies` of each.
// Wherever a plane is placed, almost all of them are on one side of it.
inline Triangles geometric_progression(int copies, int lowest = -149, int highest = 60) {
    Triangles triangles;
    for (glm::length_t axis = 0; axis < 3; ++axis) {
        for (int exponent = lowest; exponent <= highest; ++exponent) {
            glm::vec3 a(0.0F);
            a[axis] = std::ldexp(1.0F, exponent);
            triangles.insert(triangles.end(), static_cast<std::size_t>(copies), {a, 1.25F * a, 1.5F * a});
        }
    }
    return triangles;
}

}  // namespace candela::test
