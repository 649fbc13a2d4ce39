#include "engine/bvh/bvh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <random>
#include <span>
#include <vector>

#include <doctest/doctest.h>
#include <rapidcheck.h>
#include <glm/geometric.hpp>

#include "tests/engine/random_triangles.hpp"
#include "tests/seed.hpp"

TEST_SUITE("BVH") {

namespace {

using namespace candela;
using namespace candela::test;
struct Shape {
    std::uint32_t depth = 0;
    std::uint32_t largest_leaf = 0;
};

// Checks everything that the header promises about the layout.
Shape check_layout(const Bvh& bvh, std::size_t n) {
    REQUIRE(bvh.nodes.size() >= 1);
    CHECK(bvh.nodes.size() <= 2 * n - 1);

    std::vector<std::uint32_t> sorted = bvh.order;
    std::sort(sorted.begin(), sorted.end());
    std::vector<std::uint32_t> all(n);
    std::iota(all.begin(), all.end(), 0U);
    CHECK(sorted == all);

    Shape shape;
    std::vector<std::uint32_t> depth(bvh.nodes.size(), 0);
    std::vector<std::uint32_t> node_uses(bvh.nodes.size(), 0);
    std::vector<std::uint32_t> order_uses(n, 0);
    for (std::uint32_t i = 0; i < bvh.nodes.size(); ++i) {
        const BvhNode& node = bvh.nodes[i];
        shape.depth = std::max(shape.depth, depth[i]);
        shape.largest_leaf = std::max(shape.largest_leaf, node.count);
        for (std::uint32_t k = 0; k < node.count; ++k) {
            ++order_uses.at(node.first + k);
        }
        if (node.count > 0) continue;
        REQUIRE(node.first > i);
        CHECK(node.first % 2 == 1);
        for (const std::uint32_t child : {node.first, node.first + 1}) {
            depth.at(child) = depth[i] + 1;
            ++node_uses.at(child);
        }
    }
    node_uses[0] += 1;
    CHECK(std::count(node_uses.begin(), node_uses.end(), 1U) ==
          static_cast<std::ptrdiff_t>(bvh.nodes.size()));
    CHECK(std::count(order_uses.begin(), order_uses.end(), 1U) == static_cast<std::ptrdiff_t>(n));
    CHECK(shape.depth <= bvh_max_depth);
    CHECK(shape.depth == bvh.depth);
    CHECK(shape.largest_leaf <= 4);
    return shape;
}

void check_boxes(const Bvh& bvh, std::span<const Triangle> triangles) {
    std::size_t escaped = 0;
    for (const BvhNode& node : bvh.nodes) {
        escaped += count_escaped(bvh, node, triangles);
    }
    CHECK(escaped == 0);
}

Shape check_build(std::span<const Triangle> triangles) {
    const Bvh bvh = build_bvh(triangles);
    check_boxes(bvh, triangles);
    return check_layout(bvh, triangles.size());
}

TEST_CASE("bvh: without triangles there are no nodes and no hits") {
    Bvh bvh = build_bvh({});
    CHECK(bvh.nodes.empty());
    CHECK(bvh.order.empty());
    CHECK(sah_cost(bvh) == 0.0F);
    refit(bvh, {});
    CHECK_FALSE(closest_hit(bvh, {}, {{0, 0, 0}, {0, 0, 1}}));
    CHECK_FALSE(any_hit(bvh, {}, {{0, 0, 0}, {0, 0, 1}}));
}

TEST_CASE("bvh: one triangle is one leaf") {
    const Triangles triangles{{{0, 0, 2}, {1, 0, 2}, {0, 1, 2}}};
    const Bvh bvh = build_bvh(triangles);
    check_layout(bvh, 1);
    CHECK(bvh.nodes[0].count == 1);
    CHECK(bvh.nodes[0].lower == glm::vec3(0, 0, 2));
    CHECK(bvh.nodes[0].upper == glm::vec3(1, 1, 2));
    CHECK(sah_cost(bvh) == 1.0F);

    const auto hit = closest_hit(bvh, triangles, {{0.25F, 0.5F, 0}, {0, 0, 4}});
    REQUIRE(hit);
    CHECK(hit->t == 0.5F);
    CHECK(hit->u == 0.25F);
    CHECK(hit->v == 0.5F);
    CHECK(closest_hit(bvh, triangles, {{0.25F, 0.5F, 4}, {0, 0, -1}}));
    CHECK_FALSE(closest_hit(bvh, triangles, {{0.25F, 0.5F, 0}, {0, 0, -1}}));
    CHECK_FALSE(closest_hit(bvh, triangles, {{0.75F, 0.5F, 0}, {0, 0, 1}}));
}

TEST_CASE("bvh: hits equal brute force in random scenes") {
    Random random(2);
    for (const std::size_t n : {2U, 37U, 500U, 3000U}) {
        CAPTURE(n);
        const Triangles triangles = soup(n, std::pow(static_cast<float>(n), -1.0F / 3.0F), random);
        const Bvh bvh = build_bvh(triangles);
        check_layout(bvh, n);
        check_boxes(bvh, triangles);
        CHECK(disagreements(bvh, triangles, 2000, random) == 0);
    }
}

// Small integer coordinates produce what real scenes are full of: shared planes and edges, duplicates,
// degenerate triangles, rays along axes, in planes, through vertices.
glm::vec3 lattice_point(int reach) {
    const int x = *rc::gen::inRange(-reach, reach + 1);
    const int y = *rc::gen::inRange(-reach, reach + 1);
    return {x, y, *rc::gen::inRange(-reach, reach + 1)};
}

TEST_CASE("bvh: hits equal brute force on a lattice" * doctest::test_suite("random")) {
    CHECK(rc::check("closest and any hit agree", [] {
        Triangles triangles(*rc::gen::inRange<std::size_t>(0, 60));
        for (Triangle& triangle : triangles) {
            triangle = {lattice_point(3), lattice_point(3), lattice_point(3)};
        }
        const Bvh bvh = build_bvh(triangles);
        for (int i = 0; i < 20; ++i) {
            Ray ray{lattice_point(4), lattice_point(2)};
            ray.t_min = 0.5F * static_cast<float>(*rc::gen::inRange(0, 3));
            ray.t_max = *rc::gen::element(1.0F, 2.5F, infinity);
            RC_ASSERT(agrees_with_brute_force(bvh, triangles, ray));
        }
    }));
}

TEST_CASE("bvh: rays in the planes of triangles agree with brute force") {
    // Determinants of such rays are only rounding errors, and so are their hits.
    Random random(3);
    const Triangles triangles = soup(200, 0.5F, random);
    const Bvh bvh = build_bvh(triangles);
    std::size_t wrong = 0;
    for (const Triangle& triangle : triangles) {
        for (int i = 0; i < 20; ++i) {
            const glm::vec3 ab = triangle.b - triangle.a;
            const glm::vec3 ac = triangle.c - triangle.a;
            const glm::vec3 origin = triangle.a + random.number(-2, 2) * ab + random.number(-2, 2) * ac;
            const glm::vec3 direction = random.number(-1, 1) * ab + random.number(-1, 1) * ac;
            wrong += agrees_with_brute_force(bvh, triangles, {origin, direction}) ? 0 : 1;
        }
    }
    CHECK(wrong == 0);
}

TEST_CASE("bvh: axis-parallel rays hit the edges of boxes") {
    // A unit square in each coordinate plane. Every ray below runs within a face of some node's box.
    const Triangles triangles{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, {{0, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                              {{0, 0, 0}, {0, 1, 0}, {0, 1, 1}}, {{0, 0, 0}, {0, 1, 1}, {0, 0, 1}},
                              {{0, 0, 0}, {1, 0, 1}, {1, 0, 0}}, {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}}};
    const Bvh bvh = build_bvh(triangles);
    for (const float x : {0.0F, 0.5F, 1.0F}) {
        for (const float zero : {0.0F, -0.0F}) {
            CAPTURE(x);
            const Ray down_z{{x, 0.5F, 3}, {zero, zero, -1}};
            const Ray up_y{{0.5F, -3, x}, {zero, 1, zero}};
            for (const Ray& ray : {down_z, up_y}) {
                const auto hit = closest_hit(bvh, triangles, ray);
                REQUIRE(hit);
                CHECK(hit->t == 3.0F);
                CHECK(agrees_with_brute_force(bvh, triangles, ray));
            }
        }
    }
    CHECK_FALSE(any_hit(bvh, triangles, {{0.5F, 0.5F, 0.5F}, {0, 0, 0}}));
}

TEST_CASE("bvh: of duplicate triangles the one with the lowest index is hit") {
    Random random(4);
    const Triangles originals = soup(50, 0.3F, random);
    Triangles triangles;
    for (int copy = 0; copy < 9; ++copy) {
        triangles.insert(triangles.end(), originals.begin(), originals.end());
    }
    const Bvh bvh = build_bvh(triangles);
    check_layout(bvh, triangles.size());
    for (int i = 0; i < 2000; ++i) {
        const auto hit = closest_hit(bvh, triangles, ray_through(random));
        if (hit) CHECK(hit->triangle < originals.size());
    }
    CHECK(disagreements(bvh, triangles, 1000, random) == 0);
}

TEST_CASE("bvh: triangles with equal centroids are split into small leaves of a shallow tree") {
    Random random(5);
    Triangles triangles;
    for (int i = 0; i < 1000; ++i) {
        const glm::vec3 corner = random.point(1.0F);
        triangles.push_back({corner, -corner, glm::vec3(0.0F)});
    }
    CHECK(check_build(triangles).depth == 8);  // a balanced tree with 1000 / 4 leaves
    CHECK(check_build(Triangles(4096, triangles.front())).depth == 10);
}

TEST_CASE("bvh: degenerate triangles are kept and never hit") {
    Random random(6);
    Triangles triangles;
    for (int i = 0; i < 300; ++i) {
        const glm::vec3 point = random.point(1.0F);
        triangles.push_back({point, point, point});
        triangles.push_back({point, -point, point});
    }
    check_build(triangles);
    const Bvh bvh = build_bvh(triangles);
    for (int i = 0; i < 500; ++i) {
        CHECK_FALSE(any_hit(bvh, triangles, ray_through(random)));
    }
}

TEST_CASE("bvh: no input exceeds the bounds on depth and nodes") {
    // Splitting by surface area alone would give depths of 76 and 84.
    CHECK(check_build(geometric_progression(1)).depth == bvh_max_depth);
    CHECK(check_build(geometric_progression(100)).depth == bvh_max_depth);

    Triangles nested;
    for (int exponent = -120; exponent <= 120; ++exponent) {
        const float size = std::ldexp(1.0F, exponent);
        nested.push_back({{0, 0, 0}, {size, 0, 0}, {0, size, size}});
    }
    check_build(nested);
}

TEST_CASE("bvh: NaN and infinite vertices do not hang the build and do not hide other triangles") {
    Random random(7);
    const Triangles triangles = soup_with_bad_vertices(random);
    const Bvh bvh = build_bvh(triangles);
    check_layout(bvh, triangles.size());
    CHECK(disagreements(bvh, triangles, 1000, random) == 0);
    CHECK_FALSE(any_hit(bvh, triangles, {glm::vec3(not_a_number), glm::vec3(not_a_number)}));
    check_layout(build_bvh(Triangles(100, triangles[0])), 100);
}

TEST_CASE("bvh: after refitting, boxes and hits are correct, whatever has moved") {
    Random random(8);
    Triangles triangles = soup(600, 0.1F, random);
    Bvh bvh = build_bvh(triangles);
    const float built = sah_cost(bvh);
    for (int frame = 0; frame < 5; ++frame) {
        for (Triangle& triangle : triangles) {
            triangle = triangle_near(random.point(1.0F), 0.1F, random);
        }
        refit(bvh, triangles);
        check_layout(bvh, triangles.size());
        check_boxes(bvh, triangles);
        CHECK(disagreements(bvh, triangles, 500, random) == 0);
    }
    CHECK(sah_cost(bvh) > 2.0F * built);  // neighbours are now scattered over the whole cube
    CHECK(sah_cost(build_bvh(triangles)) < 2.0F * built);
}

TEST_CASE("bvh: refitting to the same triangles changes nothing") {
    Random random(9);
    const Triangles triangles = soup(300, 0.2F, random);
    const Bvh built = build_bvh(triangles);
    Bvh fitted = build_bvh(triangles);
    refit(fitted, triangles);
    CHECK(built.order == fitted.order);
    REQUIRE(built.nodes.size() == fitted.nodes.size());
    for (std::size_t i = 0; i < built.nodes.size(); ++i) {
        CHECK(built.nodes[i].lower == fitted.nodes[i].lower);
        CHECK(built.nodes[i].upper == fitted.nodes[i].upper);
        CHECK(built.nodes[i].first == fitted.nodes[i].first);
        CHECK(built.nodes[i].count == fitted.nodes[i].count);
    }
}

TEST_CASE("bvh: the cost of a split follows from the surface areas of its boxes") {
    // Boxes of 1 × 1 × 0 (half area 1) at both ends of a box of 1 × 1 × 10 (half area 21): the root costs 1,
    // each leaf costs its one triangle times 1/21.
    const Triangles triangles{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 0, 10}, {1, 0, 10}, {0, 1, 10}}};
    CHECK(sah_cost(build_bvh(triangles)) == doctest::Approx(1.0 + 2.0 / 21.0));
}

}  // namespace

}  // TEST_SUITE("BVH")
