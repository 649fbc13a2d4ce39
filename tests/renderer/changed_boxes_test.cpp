#include "renderer/passes/scene/changed_boxes.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <glm/vector_relational.hpp>
#include <random>
#include <vector>

#include "tests/seed.hpp"

TEST_SUITE("changed boxes") {

using namespace candela;

namespace {

bool contains(const glm::vec3& lower, const glm::vec3& upper, const Box& box) {
    return glm::all(glm::lessThanEqual(lower, box.lower)) &&
           glm::all(glm::greaterThanEqual(upper, box.upper));
}

/// Cubes with edges of 0.1, with corners in a unit cube.
std::vector<Box> random_boxes(std::size_t count) {
    std::mt19937 engine(test_seed());
    std::uniform_real_distribution<float> number(0.0F, 1.0F);
    std::vector<Box> boxes;
    boxes.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec3 lower(number(engine), number(engine), number(engine));
        boxes.push_back({lower, lower + 0.1F});
    }
    return boxes;
}

bool is_leaf(const std::vector<gpu::ChangedBox>& tree, std::size_t i) {
    return tree[i].next == i + 1;
}

}  // namespace

TEST_CASE("few boxes stay as they are, of many each is in a group") {
    const std::vector<Box> boxes = random_boxes(100);
    CHECK(grouped(boxes, 100) == boxes);
    CHECK(grouped({}, 1).empty());
    for (const std::size_t most : {1U, 2U, 7U, 64U, 99U}) {
        CAPTURE(most);
        const std::vector<Box> groups = grouped(boxes, most);
        CHECK(groups.size() == most);
        for (const Box& box : boxes) {
            const bool is_in_a_group = std::ranges::any_of(
                groups, [&](const Box& group) { return contains(group.lower, group.upper, box); });
            CHECK(is_in_a_group);
        }
    }
}

TEST_CASE("groups are of boxes that are close together") {
    std::vector<Box> boxes;
    boxes.reserve(16);
    for (int i = 0; i < 8; ++i) {  // by turns at two places
        for (const glm::vec3 corner : {glm::vec3(0.0F), glm::vec3(9.0F, 0.0F, 0.0F)}) {
            const glm::vec3 lower = corner + 0.1F * static_cast<float>(i);
            boxes.push_back({lower, lower + 0.1F});
        }
    }
    for (const Box& group : grouped(boxes, 2)) CHECK(group.upper.x - group.lower.x < 1.0F);
}

TEST_CASE("each box is a leaf of the tree, in all boxes above it") {
    for (const std::size_t count : {0U, 1U, 2U, 3U, 100U}) {
        CAPTURE(count);
        const std::vector<Box> boxes = random_boxes(count);
        constexpr float slack = 0.01F;
        const std::vector<gpu::ChangedBox> tree = box_tree(boxes, slack);
        CHECK(tree.size() == (count == 0 ? 0 : 2 * count - 1));
        std::size_t leaves = 0;
        for (std::size_t i = 0; i < tree.size(); ++i) {
            REQUIRE(tree[i].next > i);
            REQUIRE(tree[i].next <= tree.size());
            for (std::size_t j = i + 1; j < tree[i].next; ++j) {
                CHECK(tree[j].next <= tree[i].next);
                CHECK(contains(tree[i].lower, tree[i].upper, {tree[j].lower, tree[j].upper}));
            }
            if (is_leaf(tree, i)) ++leaves;
        }
        CHECK(leaves == count);
        for (const Box& box : boxes) {
            std::size_t found = 0;
            for (std::size_t i = 0; i < tree.size(); ++i) {
                const bool is_same = tree[i].lower == box.lower - slack && tree[i].upper == box.upper + slack;
                if (is_leaf(tree, i) && is_same) ++found;
            }
            CHECK(found == 1);
        }
    }
}

}  // TEST_SUITE("changed boxes")
