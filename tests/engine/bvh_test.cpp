#include "engine/bvh/two_level.hpp"

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

#include "engine/bvh/kept_top.hpp"
#include "engine/bvh/traverse.hpp"
#include "engine/bvh/wide.hpp"
#include "tests/seed.hpp"

TEST_SUITE("BVH") {

namespace {

using namespace candela;
using Triangles = std::vector<Triangle>;

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

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

Triangle triangle_near(const glm::vec3& centre, float reach, Random& random) {
    const glm::vec3 a = centre + random.point(reach);
    const glm::vec3 b = centre + random.point(reach);
    return {a, b, centre + random.point(reach)};
}

// Triangles of about `reach` metres, scattered in a cube of edge 2 m around the origin.
Triangles soup(std::size_t n, float reach, Random& random) {
    Triangles triangles;
    for (std::size_t i = 0; i < n; ++i) {
        triangles.push_back(triangle_near(random.point(1.0F), reach, random));
    }
    return triangles;
}

Ray ray_through(Random& random) {
    const glm::vec3 origin = random.point(1.5F);
    return {origin, random.point(1.0F) - origin};
}

// Tests every triangle, without the hierarchy.
std::optional<Hit> brute_force(std::span<const Triangle> triangles, const Ray& ray) {
    std::optional<Hit> closest;
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        const auto hit = intersect(triangles[i], i, ray);
        if (hit && (!closest || hit->t < closest->t)) closest = hit;
    }
    return closest;
}

bool same(const std::optional<Hit>& a, const std::optional<Hit>& b) {
    if (!a || !b) return a.has_value() == b.has_value();
    return a->triangle == b->triangle && a->t == b->t && a->u == b->u && a->v == b->v;
}

/// Wide nodes, whose leaves are entries of `order`.
struct Wide {
    std::vector<WideNode> nodes;
    std::vector<std::uint32_t> order;
};

/// The box of a child, as shaders compute it.
Box child_box(const WideNode& node, std::uint32_t child) {
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

std::optional<Hit> closest_hit(const Wide& wide, std::span<const Triangle> triangles, const Ray& ray) {
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

bool any_hit(const Wide& wide, std::span<const Triangle> triangles, const Ray& ray) {
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

bool contains(const BvhNode& node, const glm::vec3& lower, const glm::vec3& upper) {
    return glm::all(glm::lessThanEqual(node.lower, lower)) &&
           glm::all(glm::greaterThanEqual(node.upper, upper));
}

bool contains(const BvhNode& node, const Triangle& triangle) {
    return contains(node, glm::min(triangle.a, glm::min(triangle.b, triangle.c)),
                    glm::max(triangle.a, glm::max(triangle.b, triangle.c)));
}

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

// Number of the node's triangles or children that are not in its box.
std::size_t count_escaped(const Bvh& bvh, const BvhNode& node, std::span<const Triangle> triangles) {
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

// Triangles with edge lengths and distances of 2^lowest ... 2^highest m along each axis, `copies` of each.
// Wherever a plane is placed, almost all of them are on one side of it.
Triangles geometric_progression(int copies, int lowest = -149, int highest = 60) {
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
    Triangles triangles = soup(200, 0.2F, random);
    for (std::size_t i = 0; i < triangles.size(); i += 3) {
        triangles[i].b.y = i % 2 == 0 ? nan : infinity;
        if (i % 4 == 0) triangles[i] = {glm::vec3(nan), glm::vec3(nan), glm::vec3(nan)};
    }
    const Bvh bvh = build_bvh(triangles);
    check_layout(bvh, triangles.size());
    CHECK(disagreements(bvh, triangles, 1000, random) == 0);
    CHECK_FALSE(any_hit(bvh, triangles, {glm::vec3(nan), glm::vec3(nan)}));
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

/// Objects with hierarchies of their own under one top, as the renderer keeps them.
class Objects {
 public:
    void add(Triangles triangles) {
        objects_.push_back({std::move(triangles), {}, next_node_, next_triangle_});
        objects_.back().bvh = build_bvh(objects_.back().triangles, object_max_depth);
        next_node_ += static_cast<std::uint32_t>(objects_.back().bvh.nodes.size()) + 5;
        next_triangle_ += static_cast<std::uint32_t>(objects_.back().bvh.order.size()) + 3;
        std::vector<std::uint32_t> same(objects_.size() - 1);
        std::iota(same.begin(), same.end(), 0U);
        top_.renumber(same, objects_.size());
        top_.insert(placed_objects(), static_cast<std::uint32_t>(objects_.size() - 1));
        keep_or_build();
    }
    void remove(std::size_t i) {
        std::vector<std::uint32_t> now(objects_.size());
        std::iota(now.begin(), now.begin() + static_cast<std::ptrdiff_t>(i), 0U);
        std::iota(now.begin() + static_cast<std::ptrdiff_t>(i) + 1, now.end(), static_cast<std::uint32_t>(i));
        now[i] = KeptTop::gone;
        objects_.erase(objects_.begin() + static_cast<std::ptrdiff_t>(i));
        top_.renumber(now, objects_.size());
        keep_or_build();
    }
    template <class Change>
    void move(std::size_t i, Change change) {
        for (Triangle& t : objects_[i].triangles) {
            t = {change(t.a), change(t.b), change(t.c)};
        }
        refit(objects_[i].bvh, objects_[i].triangles);
        top_.refit(placed_objects(), std::array{static_cast<std::uint32_t>(i)});
        keep_or_build();
    }
    /// Whether the top is kept where it may be, instead of being built again each time.
    bool keeps = false;
    [[nodiscard]] int kept() const { return kept_; }
    [[nodiscard]] const Bvh& top() const { return top_.top().bvh; }

    [[nodiscard]] std::size_t size() const { return objects_.size(); }
    [[nodiscard]] Triangles triangles() const {
        Triangles all;
        for (const Object& object : objects_) {
            all.insert(all.end(), object.triangles.begin(), object.triangles.end());
        }
        return all;
    }

    /// All as one hierarchy over `triangles`, with gaps between the objects' nodes.
    [[nodiscard]] Bvh joint() const {
        const std::vector<PlacedBvh> objects = placed_objects();
        const auto placed = [](const PlacedBvh& object, BvhNode node) {
            node.first += node.count == 0 ? object.first_node - 1 : object.first_triangle;
            return node;
        };
        const TopBvh& top = top_.top();
        Bvh bvh{top.bvh.nodes, joint_order()};
        for (BvhNode& node : bvh.nodes) {
            if (node.count == 0) continue;
            const TopBvh::Leaf& leaf = top.leaves[top.bvh.order[node.first]];
            node = placed(objects[leaf.object], objects_[leaf.object].bvh.nodes[leaf.node]);
        }
        for (std::size_t i = 0; i < objects_.size(); ++i) {
            const Bvh& own = objects_[i].bvh;
            for (std::size_t n = 1; n < own.nodes.size(); ++n) {
                const std::size_t at = objects[i].first_node + n - 1;
                bvh.nodes.resize(std::max(bvh.nodes.size(), at + 1));
                bvh.nodes[at] = placed(objects[i], own.nodes[n]);
            }
        }
        return bvh;
    }

    /// The same with wide nodes, as the GPU has them.
    [[nodiscard]] Wide wide() const {
        const std::vector<PlacedBvh> objects = placed_objects();
        Wide all{wide_nodes(top_.top(), objects), joint_order()};
        for (const PlacedBvh& object : objects) {
            const std::vector<WideNode> own = wide_nodes(object);
            all.nodes.resize(std::max(all.nodes.size(), object.first_node + own.size()));
            std::ranges::copy(own, all.nodes.begin() + object.first_node);
        }
        return all;
    }

    std::uint32_t most_opened = 1024;

 private:
    struct Object {
        Triangles triangles;
        Bvh bvh;
        std::uint32_t first_node;
        std::uint32_t first_triangle;
    };

    void keep_or_build() {
        if (keeps && !top_.is_worn()) {
            ++kept_;
        } else {
            top_.build(placed_objects(), most_opened);
        }
        check_changed();
    }

    /// The wide nodes that are said to have changed are all that have.
    void check_changed() {
        const std::vector<PlacedBvh> objects = placed_objects();
        const std::vector<WideNode> now = wide_nodes(top_.top(), objects);
        if (const auto changed = top_.take_changed()) {
            top_nodes_.resize(now.size());
            for (const std::uint32_t i : *changed) top_nodes_[i] = wide_node_at(top_.top(), objects, i);
        } else {
            top_nodes_ = now;
        }
        const auto same = [](const WideNode& a, const WideNode& b) {
            return a.origin == b.origin && a.exponents == b.exponents && a.lower == b.lower &&
                   a.upper == b.upper && a.children == b.children;
        };
        std::size_t missed = 0;
        for (std::size_t i = 0; i < now.size(); ++i) {
            const std::vector<BvhNode>& nodes = top_.top().bvh.nodes;
            const bool is_used = nodes.size() < 3 || !is_unused(nodes[2 * i + 1]);
            missed += is_used && !same(now[i], top_nodes_[i]) ? 1 : 0;
        }
        CHECK(missed == 0);
    }

    [[nodiscard]] std::vector<PlacedBvh> placed_objects() const {
        std::vector<PlacedBvh> placed;
        for (const Object& object : objects_) {
            placed.push_back({&object.bvh, object.first_node, object.first_triangle});
        }
        return placed;
    }

    /// Indices of `triangles()` by place in the joint array.
    [[nodiscard]] std::vector<std::uint32_t> joint_order() const {
        const std::vector<PlacedBvh> objects = placed_objects();
        std::vector<std::uint32_t> order;
        std::uint32_t first_index = 0;
        for (std::size_t i = 0; i < objects_.size(); ++i) {
            const Bvh& own = objects_[i].bvh;
            for (std::size_t n = 0; n < own.order.size(); ++n) {
                const std::size_t at = objects[i].first_triangle + n;
                order.resize(std::max(order.size(), at + 1));
                order[at] = first_index + own.order[n];
            }
            first_index += static_cast<std::uint32_t>(own.order.size());
        }
        return order;
    }

    std::vector<Object> objects_;
    KeptTop top_;
    std::vector<WideNode> top_nodes_;  // kept by what take_changed says
    int kept_ = 0;
    std::uint32_t next_node_ = 4000;  // behind those of the top
    std::uint32_t next_triangle_ = 3;
};

// From the root, every triangle is reached once, in boxes that contain it, and no leaf is too deep for the
// stack. Returns the depth.
std::uint32_t check_joint(const Bvh& bvh, std::span<const Triangle> triangles) {
    std::size_t escaped = 0;
    std::vector<std::uint32_t> found;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> waiting;  // nodes and their depths
    std::uint32_t deepest = 0;
    if (!bvh.nodes.empty()) waiting.emplace_back(0, 0);
    while (!waiting.empty()) {
        const auto [index, depth] = waiting.back();
        waiting.pop_back();
        const BvhNode& node = bvh.nodes.at(index);
        deepest = std::max(deepest, depth);
        escaped += count_escaped(bvh, node, triangles);
        for (std::uint32_t i = 0; i < node.count; ++i) {
            found.push_back(bvh.order.at(node.first + i));
        }
        if (node.count == 0) {
            waiting.emplace_back(node.first, depth + 1);
            waiting.emplace_back(node.first + 1, depth + 1);
        }
    }
    std::sort(found.begin(), found.end());
    std::vector<std::uint32_t> all(triangles.size());
    std::iota(all.begin(), all.end(), 0U);
    CHECK(found == all);
    CHECK(escaped == 0);
    CHECK(deepest <= bvh_max_depth);
    return deepest;
}

// Every triangle is reached once, through boxes that contain it.
void check_wide(const Wide& wide, std::span<const Triangle> triangles) {
    std::vector<std::uint32_t> found;
    std::size_t escaped = 0;
    traverse_wide(
        wide, [](const Box&) { return true; },
        [&](std::uint32_t i, const Box& box) {
            found.push_back(i);
            escaped += contains({box.lower, 0, box.upper, 0}, triangles[i]) ? 0 : 1;
        });
    std::sort(found.begin(), found.end());
    std::vector<std::uint32_t> all(triangles.size());
    std::iota(all.begin(), all.end(), 0U);
    CHECK(found == all);
    CHECK(escaped == 0);
}

TEST_CASE("bvh: two levels: hits equal brute force after each of many moves, additions and removals") {
    Random random(test_seed(13));
    for (const std::uint32_t variant : {0U, 1U, 2U, 3U, 4U, 5U}) {
        const std::uint32_t most_opened = std::array{0U, 5U, 1024U}[variant % 3];
        const bool keeps = variant >= 3;
        CAPTURE(most_opened);
        CAPTURE(keeps);
        Objects objects;
        objects.most_opened = most_opened;
        objects.keeps = keeps;
        for (int edit = 0; edit < 60; ++edit) {
            const auto any =
                static_cast<std::size_t>(random.number(0, 0.999F) * static_cast<float>(objects.size()));
            const float choice = random.number(0, 1);
            if (objects.size() == 0 || choice < 0.4F) {
                // From none to a few hundred triangles, tiny or across the whole scene.
                const auto n = static_cast<std::size_t>(std::exp2(random.number(-1, 8)));
                objects.add(soup(n, random.number(0.01F, 1.0F), random));
            } else if (choice < 0.6F) {
                objects.remove(any);
            } else {
                const glm::vec3 by = random.point(0.5F);
                const float scale = random.number(-1.5F, 1.5F);
                objects.move(any, [&](glm::vec3 p) { return scale * glm::vec3(p.y, p.z, p.x) + by; });
            }
            const Triangles triangles = objects.triangles();
            const Bvh joint = objects.joint();
            check_joint(joint, triangles);
            CHECK(disagreements(joint, triangles, 100, random) == 0);
            check_wide(objects.wide(), triangles);
            CHECK(disagreements(objects.wide(), triangles, 100, random) == 0);
        }
    }
}

TEST_CASE("bvh: two levels: a top is kept through hundreds of edits, and rays hardly cost more") {
    Random random(test_seed(16));
    Objects objects;
    objects.keeps = true;
    objects.most_opened = 0;
    const auto add = [&] {
        const glm::vec3 by = random.point(10.0F);
        Triangles triangles = soup(4, 0.3F, random);
        for (Triangle& t : triangles) t = {t.a + by, t.b + by, t.c + by};
        objects.add(std::move(triangles));
    };
    for (int i = 0; i < 200; ++i) add();
    const int before = objects.kept();
    constexpr int edits = 300;
    for (int edit = 0; edit < edits; ++edit) {
        const auto any =
            static_cast<std::size_t>(random.number(0, 0.999F) * static_cast<float>(objects.size()));
        const float choice = random.number(0, 1);
        if (choice < 0.3F) {
            add();
        } else if (choice < 0.6F) {
            objects.remove(any);
        } else {
            const glm::vec3 by = random.point(3.0F);
            objects.move(any, [&](glm::vec3 p) { return p + by; });
        }
    }
    // Objects move at random through a third of the scene, so that a few builds are due.
    CHECK(objects.kept() - before > edits - 15);
    const Triangles triangles = objects.triangles();
    CHECK(disagreements(objects.joint(), triangles, 300, random) == 0);
    check_wide(objects.wide(), triangles);
    // Half as much again is what a top may cost before it is worn.
    const float kept = sah_cost(objects.top());
    objects.keeps = false;
    objects.move(0, [](glm::vec3 p) { return p; });
    CHECK(kept <= 2.0F * sah_cost(objects.top()));
}

TEST_CASE("bvh: two levels: things that come in rows do not make the top deep or expensive") {
    Random random(test_seed(18));
    Objects objects;
    objects.keeps = true;
    objects.most_opened = 0;
    for (int i = 0; i < 400; ++i) {
        const glm::vec3 at(i % 20, 0.0F, i / 20);
        Triangles triangles = soup(4, 0.3F, random);
        for (Triangle& t : triangles) t = {0.3F * t.a + at, 0.3F * t.b + at, 0.3F * t.c + at};
        objects.add(std::move(triangles));
    }
    // Objects are 1 m apart. The first ones come at the sides of a small scene, where each is a large part.
    CHECK(objects.kept() > 350);
    const float kept = sah_cost(objects.top());
    objects.keeps = false;
    objects.move(0, [](glm::vec3 p) { return p; });
    CHECK(kept < 1.3F * sah_cost(objects.top()));
}

TEST_CASE("bvh: two levels: of objects in the same place the first one is hit") {
    Random random(10);
    const Triangles originals = soup(40, 0.4F, random);
    Objects objects;
    for (int copy = 0; copy < 5; ++copy) {
        objects.add(originals);
    }
    const Triangles triangles = objects.triangles();
    CHECK(disagreements(objects.joint(), triangles, 2000, random) == 0);
    CHECK(disagreements(objects.wide(), triangles, 2000, random) == 0);
}

TEST_CASE("bvh: two levels: no input exceeds the bound on depth") {
    CHECK(build_bvh(geometric_progression(1), object_max_depth).depth == object_max_depth);
    Objects objects;
    for (int i = 0; i < 4; ++i) {
        objects.add(geometric_progression(1));
    }
    check_joint(objects.joint(), objects.triangles());
    check_wide(objects.wide(), objects.triangles());
    // As deep as possible in both levels: single triangles around a small, deep object, which is at the
    // deepest place of the top.
    Objects nested;
    nested.most_opened = 0;
    nested.add(geometric_progression(1, -149, -61));
    for (const Triangle& triangle : geometric_progression(1, -60, 60)) {
        nested.add({triangle});
    }
    CHECK(check_joint(nested.joint(), nested.triangles()) > object_max_depth);
    check_wide(nested.wide(), nested.triangles());
}

TEST_CASE("bvh: wide: hits equal brute force for triangles of 0.1 mm to 100 km, far from the origin too") {
    Random random(test_seed(14));
    for (const float away : {0.0F, 100.0F, 1e5F, 1e7F}) {
        CAPTURE(away);
        Objects objects;
        Triangles triangles;
        for (int i = 0; i < 400; ++i) {
            const glm::vec3 centre =
                glm::vec3(away, -away, 0.5F * away) + random.point(std::pow(10.0F, random.number(-4, 5)));
            Triangle triangle = triangle_near(centre, std::pow(10.0F, random.number(-4, 5)), random);
            // Every third one is parallel to an axis, with a box that is flat.
            const glm::length_t axis = i % 9;
            if (axis < 3) triangle.b[axis] = triangle.c[axis] = triangle.a[axis];
            triangles.push_back(triangle);
        }
        objects.add(triangles);
        const Wide wide = objects.wide();
        check_wide(wide, triangles);
        std::size_t wrong = 0;
        std::size_t hits = 0;
        for (std::size_t i = 0; i < triangles.size(); ++i) {
            const Triangle& t = triangles[i];
            const glm::vec3 middle = (t.a + t.b + t.c) / 3.0F;
            const glm::vec3 from = middle + random.point(std::pow(10.0F, random.number(-4, 5)));
            const Ray ray{from, middle - from};
            hits += any_hit(wide, triangles, ray) ? 1 : 0;
            wrong += agrees_with_brute_force(wide, triangles, ray) ? 0 : 1;
        }
        CHECK(wrong == 0);
        CHECK(hits > triangles.size() / 2);
    }
}

TEST_CASE("bvh: wide: NaN and infinite vertices do not hide other triangles") {
    Random random(15);
    Triangles triangles = soup(200, 0.2F, random);
    for (std::size_t i = 0; i < triangles.size(); i += 3) {
        triangles[i].b.y = i % 2 == 0 ? nan : infinity;
        if (i % 4 == 0) triangles[i] = {glm::vec3(nan), glm::vec3(nan), glm::vec3(nan)};
    }
    Objects objects;
    objects.add(triangles);
    CHECK(disagreements(objects.wide(), triangles, 1000, random) == 0);
}

TEST_CASE("bvh: wide: a box is hardly larger than what it contains") {
    const std::array<WideChild, 3> children{WideChild{{{-3, 5, 0}, {-1, 6, 0}}, 1},
                                            WideChild{{{0.3F, 7, 0}, {0.4F, 9, 0}}, 2}, WideChild{{}, 3}};
    const WideNode node = wide_node(children);
    CHECK(node.children == glm::uvec4(1, 2, 0, 0));
    // 255 steps of a power of two reach across the node, 128 do not; rounding adds less than a step.
    const glm::vec3 step = glm::vec3(3.4F, 4, 0) / 128.0F;
    for (std::uint32_t i = 0; i < 2; ++i) {
        const Box box = child_box(node, i);
        CHECK(glm::all(glm::lessThanEqual(box.lower, children[i].box.lower)));
        CHECK(glm::all(glm::greaterThanEqual(box.upper, children[i].box.upper)));
        CHECK(glm::all(glm::lessThanEqual(children[i].box.lower - box.lower, step)));
        CHECK(glm::all(glm::lessThanEqual(box.upper - children[i].box.upper, step)));
    }
}

}  // namespace

}  // TEST_SUITE("BVH")
