#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include <doctest/doctest.h>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/vector_relational.hpp>

#include "engine/bvh/kept_top.hpp"
#include "engine/bvh/wide.hpp"
#include "tests/engine/random_triangles.hpp"
#include "tests/seed.hpp"

TEST_SUITE("BVH") {

namespace {

using namespace candela;
using namespace candela::test;

/// Instances of meshes under one top, as the renderer keeps them. Each has its own mesh, in world space.
class Objects {
 public:
    void add(Triangles triangles) {
        objects_.push_back({std::move(triangles), {}, {next_node_, next_triangle_}});
        Object& added = objects_.back();
        added.bvh = build_bvh(added.triangles, mesh_max_depth);
        next_node_ += static_cast<std::uint32_t>(added.bvh.nodes.size()) + 5;
        next_triangle_ += static_cast<std::uint32_t>(added.bvh.order.size()) + 3;
        set(objects_.size() - 1);
    }
    void remove(std::size_t i) {
        // The last one takes its number.
        const std::size_t last = objects_.size() - 1;
        top_.set(static_cast<std::uint32_t>(i), {});
        top_.set(static_cast<std::uint32_t>(last), {});
        objects_[i] = objects_.back();
        objects_.pop_back();
        if (i < last) return set(i);
        keep_or_build();
    }
    template <class Change>
    void move(std::size_t i, Change change) {
        for (Triangle& t : objects_[i].triangles) {
            t = {change(t.a), change(t.b), change(t.c)};
        }
        refit(objects_[i].bvh, objects_[i].triangles);
        set(i);
    }
    /// Whether the top is kept where it may be, instead of being built again each time.
    bool keeps = false;
    [[nodiscard]] int kept() const { return kept_; }
    [[nodiscard]] const Bvh& top() const { return top_.tree(); }

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
        const auto placed = [](const Object& object, BvhNode node) {
            node.first += node.count == 0 ? object.place.first_node - 1 : object.place.first_triangle;
            return node;
        };
        Bvh bvh{top().nodes, joint_order()};
        for (BvhNode& node : bvh.nodes) {
            if (node.count == 0) continue;
            const Object& object = objects_[node.first];
            node = placed(object, object.bvh.nodes.front());
        }
        for (const Object& object : objects_) {
            for (std::size_t n = 1; n < object.bvh.nodes.size(); ++n) {
                const std::size_t at = object.place.first_node + n - 1;
                bvh.nodes.resize(std::max(bvh.nodes.size(), at + 1));
                bvh.nodes[at] = placed(object, object.bvh.nodes[n]);
            }
        }
        return bvh;
    }

    /// The same with wide nodes, as the GPU has them.
    [[nodiscard]] Wide wide() const {
        Wide all{top_nodes(top(), first_instance), joint_order()};
        all.nodes.resize(first_instance);
        for (const Object& object : objects_) {
            const bool is_empty = object.bvh.nodes.empty();
            const std::uint32_t root = is_empty ? 0 : root_word(object.bvh, object.place);
            all.nodes.push_back(instance_node(glm::mat4(1.0F), root, 0));
        }
        for (const Object& object : objects_) {
            const std::vector<WideNode> own = wide_nodes(object.bvh, object.place);
            all.nodes.resize(std::max(all.nodes.size(), object.place.first_node + own.size()));
            std::ranges::copy(own, all.nodes.begin() + object.place.first_node);
        }
        return all;
    }

 private:
    struct Object {
        Triangles triangles;
        Bvh bvh;
        MeshPlace place;
    };
    static constexpr std::uint32_t first_instance = 2000;  // behind the nodes of the top

    [[nodiscard]] static Box box_of(const Object& object) {
        if (object.bvh.nodes.empty()) return {};
        return {object.bvh.nodes.front().lower, object.bvh.nodes.front().upper};
    }

    void set(std::size_t i) {
        top_.set(static_cast<std::uint32_t>(i), box_of(objects_[i]));
        keep_or_build();
    }

    void keep_or_build() {
        if (keeps && !top_.is_worn()) {
            ++kept_;
        } else {
            std::vector<Box> boxes;
            for (const Object& object : objects_) boxes.push_back(box_of(object));
            top_.build(boxes);
        }
        check_changed();
    }

    /// The wide nodes that are said to have changed are all that have.
    void check_changed() {
        const std::vector<WideNode> now = top_nodes(top(), first_instance);
        if (const auto changed = top_.take_changed()) {
            top_nodes_.resize(now.size());
            for (const std::uint32_t i : *changed) top_nodes_[i] = top_node(top(), first_instance, i);
        } else {
            top_nodes_ = now;
        }
        std::size_t missed = 0;
        for (std::size_t i = 0; i < now.size(); ++i) {
            const std::vector<BvhNode>& nodes = top().nodes;
            const bool is_used = nodes.size() < 3 || !is_unused(nodes[2 * i + 1]);
            missed += is_used && now[i] != top_nodes_[i] ? 1 : 0;
        }
        CHECK(missed == 0);
    }

    /// Indices of `triangles()` by place in the joint array.
    [[nodiscard]] std::vector<std::uint32_t> joint_order() const {
        std::vector<std::uint32_t> order;
        std::uint32_t first_index = 0;
        for (const Object& object : objects_) {
            for (std::size_t n = 0; n < object.bvh.order.size(); ++n) {
                const std::size_t at = object.place.first_triangle + n;
                order.resize(std::max(order.size(), at + 1));
                order[at] = first_index + object.bvh.order[n];
            }
            first_index += static_cast<std::uint32_t>(object.bvh.order.size());
        }
        return order;
    }

    std::vector<Object> objects_;
    KeptTop top_;
    std::vector<WideNode> top_nodes_;  // kept by what take_changed says
    int kept_ = 0;
    std::uint32_t next_node_ = 4000;  // behind the instances
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

TEST_CASE("bvh: scene: hits equal brute force after each of many moves, additions and removals") {
    Random random(test_seed(13));
    for (const bool keeps : {false, true, true}) {
        CAPTURE(keeps);
        Objects objects;
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

TEST_CASE("bvh: scene: a top is kept through hundreds of edits, and rays hardly cost more") {
    Random random(test_seed(16));
    Objects objects;
    objects.keeps = true;
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

TEST_CASE("bvh: scene: things that come in rows do not make the top deep or expensive") {
    Random random(test_seed(18));
    Objects objects;
    objects.keeps = true;
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

TEST_CASE("bvh: scene: of objects in the same place the first one is hit") {
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

TEST_CASE("bvh: scene: no input exceeds the bound on depth") {
    CHECK(build_bvh(geometric_progression(1), mesh_max_depth).depth == mesh_max_depth);
    Objects objects;
    for (int i = 0; i < 4; ++i) {
        objects.add(geometric_progression(1));
    }
    check_joint(objects.joint(), objects.triangles());
    check_wide(objects.wide(), objects.triangles());
    // As deep as possible in both levels: single triangles around a small, deep object, which is at the
    // deepest place of the top.
    Objects nested;
    nested.add(geometric_progression(1, -149, -61));
    for (const Triangle& triangle : geometric_progression(1, -60, 60)) {
        nested.add({triangle});
    }
    CHECK(check_joint(nested.joint(), nested.triangles()) > mesh_max_depth);
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
    const Triangles triangles = soup_with_bad_vertices(random);
    Objects objects;
    objects.add(triangles);
    CHECK(disagreements(objects.wide(), triangles, 1000, random) == 0);
}

TEST_CASE("bvh: wide: an instance is the matrix that leads into its mesh's space, its root and its entity") {
    const glm::mat4 matrix =
        glm::translate(glm::rotate(glm::mat4(2.0F), 0.3F, glm::vec3(1, 2, 3)), glm::vec3(4, 5, 6));
    const WideNode node = instance_node(matrix, child_word(7, 3), 9);
    const auto row = [](const glm::uvec4& bits) { return std::bit_cast<glm::vec4>(bits); };
    const glm::vec4 first(node.origin, std::bit_cast<float>(node.exponents));
    const glm::vec4 place(-1, 0.5F, 3, 1);
    const glm::vec3 in_mesh(glm::dot(first, place), glm::dot(row(node.lower), place),
                            glm::dot(row(node.upper), place));
    // A few roundings of numbers below 32.
    CHECK(glm::all(glm::lessThan(glm::abs(in_mesh - glm::vec3(matrix * place)), glm::vec3(1e-5F))));
    CHECK(node.children == glm::uvec4(child_word(7, 3), 9, 0, 0));
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
