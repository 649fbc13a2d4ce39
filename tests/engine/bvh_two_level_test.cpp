#include "engine/bvh/two_level.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include <doctest/doctest.h>
#include <glm/vector_relational.hpp>

#include "engine/bvh/kept_top.hpp"
#include "engine/bvh/wide.hpp"
#include "tests/engine/random_triangles.hpp"
#include "tests/seed.hpp"

TEST_SUITE("BVH") {

namespace {

using namespace candela;
using namespace candela::test;

/// Objects with hierarchies of their own under one top, as the renderer keeps them.
class Objects {
 public:
    void add(Triangles triangles) {
        objects_.push_back({std::move(triangles), {}, next_node_, next_triangle_});
        objects_.back().bvh = build_bvh(objects_.back().triangles, object_max_depth);
        next_node_ += static_cast<std::uint32_t>(objects_.back().bvh.nodes.size()) + 5;
        next_triangle_ += static_cast<std::uint32_t>(objects_.back().bvh.order.size()) + 3;
        top_.insert(placed_objects(), static_cast<std::uint32_t>(objects_.size() - 1));
        keep_or_build();
    }
    void remove(std::size_t i) {
        // The last one takes its number.
        const auto last = static_cast<std::uint32_t>(objects_.size() - 1);
        top_.remove(static_cast<std::uint32_t>(i));
        top_.remove(last);
        objects_[i] = objects_.back();
        objects_.pop_back();
        if (i < last) top_.insert(placed_objects(), static_cast<std::uint32_t>(i));
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
        triangles[i].b.y = i % 2 == 0 ? not_a_number : infinity;
        if (i % 4 == 0)
            triangles[i] = {glm::vec3(not_a_number), glm::vec3(not_a_number), glm::vec3(not_a_number)};
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
