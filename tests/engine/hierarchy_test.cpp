#include <candela/scene/hierarchy.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include "engine/import/decompose.hpp"

using namespace candela;

namespace {

// The quaternion of a rotation by 90 degrees about +Z: x becomes y.
const glm::quat quarter_turn(std::sqrt(0.5F), 0.0F, 0.0F, std::sqrt(0.5F));

Transform moved(float x, float y, float z, Entity parent = {}) {
    Transform transform;
    transform.translation = {x, y, z};
    transform.parent = parent;
    return transform;
}

glm::vec3 apply(const glm::mat4& matrix, const glm::vec3& point) {
    return matrix * glm::vec4(point, 1.0F);
}

// Coordinates here are below 100, so a few single-precision roundings stay within 1e-4.
bool close(const glm::vec3& a, const glm::vec3& b) {
    return glm::distance(a, b) < 1e-4F;
}

std::string message_of(const World& world, Entity entity) {
    try {
        (void)world_matrix(world, entity);
    } catch (const SceneError& error) {
        return error.what();
    }
    return "no error";
}

double largest_difference(const glm::dmat4& a, const glm::dmat4& b) {
    double largest = 0.0;
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
            largest = std::max(largest, std::abs(a[column][row] - b[column][row]));
        }
    }
    return largest;
}

glm::dmat4 product(const std::vector<Transform>& transforms) {
    glm::dmat4 matrix(1.0);
    for (const Transform& transform : transforms) {
        matrix = matrix * glm::dmat4(local_matrix(transform));
    }
    return matrix;
}

}  // namespace

TEST_SUITE("hierarchy") {
TEST_CASE("a local matrix scales, then rotates, then translates") {
    Transform transform;
    transform.scale = {2.0F, 3.0F, 4.0F};
    transform.rotation = quarter_turn;
    transform.translation = {10.0F, 20.0F, 30.0F};
    // (1, 1, 1) scaled is (2, 3, 4), then rotated is (-3, 2, 4).
    CHECK(close(apply(local_matrix(transform), {1, 1, 1}), {7, 22, 34}));
}

TEST_CASE("a world matrix applies the ancestors' matrices in turn") {
    World world;
    const Entity root = world.create();
    Transform turned = moved(1, 0, 0);
    turned.rotation = quarter_turn;
    world.set(root, turned);
    const Entity middle = world.create();
    world.set(middle, moved(0, 0, 5, root));
    const Entity leaf = world.create();
    Transform doubled = moved(2, 0, 0, middle);
    doubled.scale = glm::vec3(2.0F);
    world.set(leaf, doubled);
    // (1, 0, 0) in the leaf is (4, 0, 0) in the middle, (4, 0, 5) in the root, (0 + 1, 4, 5) in the
    // world.
    CHECK(close(apply(world_matrix(world, leaf), {1, 0, 0}), {1, 4, 5}));
    CHECK(world_matrix(world, root) == local_matrix(turned));
}

TEST_CASE("an entity without a Transform has the identity as its world matrix") {
    World world;
    const Entity bare = world.create();
    CHECK(world_matrix(world, bare) == glm::mat4(1.0F));
    const Entity child = world.create();
    world.set(child, moved(1, 2, 3, bare));
    CHECK(apply(world_matrix(world, child), {0, 0, 0}) == glm::vec3(1, 2, 3));
}

TEST_CASE("a destroyed parent is an error that names the child") {
    World world;
    const Entity parent = world.create();
    const Entity child = world.create();
    const Entity grandchild = world.create();
    world.set(child, moved(0, 0, 0, parent));
    world.set(child, Name{"lamp shade"});
    world.set(grandchild, moved(0, 0, 0, child));
    world.destroy(parent);
    CHECK(message_of(world, grandchild) == "entity \"lamp shade\": its parent no longer exists");
}

TEST_CASE("a cycle of parents is an error that names the entity") {
    World world;
    const Entity a = world.create();
    const Entity b = world.create();
    world.set(a, moved(0, 0, 0, b));
    world.set(b, moved(0, 0, 0, a));
    world.set(a, Name{"snake"});
    CHECK(message_of(world, a) == "entity \"snake\": its parents form a cycle");
    CHECK(message_of(world, b) == "entity 1: its parents form a cycle");

    const Entity self = world.create();
    world.set(self, moved(0, 0, 0, self));
    world.set(self, Name{"ouroboros"});
    CHECK(message_of(world, self) == "entity \"ouroboros\": its parents form a cycle");
}

TEST_CASE("a chain of 100,000 entities has world matrices") {
    World world;
    std::vector<Entity> chain{Entity{}};
    for (int i = 1; i <= 100'000; ++i) {
        chain.push_back(world.create());
        world.set(chain.back(), moved(0, 0, 1.0F, *(chain.end() - 2)));
    }
    CHECK(world_matrix(world, chain.back())[3].z == 100'000.0F);
    // One after the other from the top takes milliseconds; if each climbed to the top again, minutes.
    WorldMatrices world_matrices(world);
    for (std::size_t i = 1; i < chain.size(); ++i) {
        REQUIRE(world_matrices(chain[i])[3].z == static_cast<float>(i));
    }
}

TEST_CASE("WorldMatrices gives the bits of world_matrix, in any order of entities") {
    CHECK(rc::check([] {
        World world;
        std::vector<Entity> entities;
        const auto count = *rc::gen::inRange<std::size_t>(1, 30);
        for (std::size_t i = 0; i < count; ++i) {
            const auto parent = *rc::gen::inRange<std::size_t>(0, i + 1);
            Transform transform = moved(0.1F * static_cast<float>(i), 0.3F, -0.7F);
            transform.parent = parent < i ? entities[parent] : Entity{};
            transform.scale = {1.1F, 0.9F, 1.3F};
            transform.rotation = quarter_turn;
            entities.push_back(world.create());
            if (*rc::gen::inRange(0, 8) != 0) world.set(entities.back(), transform);
        }
        WorldMatrices world_matrices(world);
        for (int i = 0; i < 40; ++i) {
            const Entity entity = *rc::gen::elementOf(entities);
            RC_ASSERT(world_matrices(entity) == world_matrix(world, entity));
        }
    }));
}

}  // TEST_SUITE("hierarchy")

TEST_SUITE("decompose") {
TEST_CASE("a matrix without shear becomes one Transform") {
    Transform original = moved(1, 2, 3);
    original.rotation = glm::normalize(glm::quat(0.5F, 0.1F, -0.7F, 0.3F));
    for (const glm::vec3 scale : {glm::vec3(1, 2, 3), glm::vec3(-1, 2, 3), glm::vec3(-1, -1, -1),
                                  glm::vec3(1, 0, 2), glm::vec3(0, 0, 2), glm::vec3(0, 0, 0)}) {
        CAPTURE(scale.x);
        original.scale = scale;
        const std::vector<Transform> transforms = decompose(glm::dmat4(local_matrix(original)));
        CHECK(transforms.size() == 1);
        CHECK(largest_difference(product(transforms), glm::dmat4(local_matrix(original))) < 1e-5);
        CHECK(std::abs(glm::length(transforms[0].rotation) - 1.0F) < 1e-6F);
    }
}

TEST_CASE("any affine matrix is the product of its transforms" * doctest::test_suite("random")) {
    CHECK(rc::check("product equals matrix", [] {
        glm::dmat4 matrix(1.0);
        for (int column = 0; column < 4; ++column) {
            for (int row = 0; row < 3; ++row) {
                matrix[column][row] = *rc::gen::inRange(-100, 101) / 10.0;
            }
        }
        const std::vector<Transform> transforms = decompose(matrix);
        RC_ASSERT(transforms.size() <= 2);
        // Entries are up to 10 and three single-precision matrices are multiplied: about 1e-6 × 10 × 3.
        RC_ASSERT(largest_difference(product(transforms), matrix) < 1e-4);
    }));
}

TEST_CASE("shear takes two transforms, the inner one a rotation") {
    glm::dmat4 shear(1.0);
    shear[1][0] = 0.5;
    const std::vector<Transform> transforms = decompose(shear);
    REQUIRE(transforms.size() == 2);
    CHECK(transforms[1].scale == glm::vec3(1.0F));
    CHECK(transforms[1].translation == glm::vec3(0.0F));
    CHECK(largest_difference(product(transforms), shear) < 1e-6);
}

}  // TEST_SUITE("decompose")
