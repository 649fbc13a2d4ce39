#include <candela/tools/scene_rays.hpp>

#include <chrono>
#include <cmath>
#include <random>
#include <utility>

#include <doctest/doctest.h>
#include <glm/gtc/constants.hpp>

#include <candela/scene/hierarchy.hpp>
#include "engine/bvh/bvh.hpp"
#include "tests/sandbox/editing_scene.hpp"

namespace candela::sandbox {

TEST_SUITE("scene rays") {

namespace {

// A few roundings of floats of magnitude 10.
constexpr float rounding = 1e-5F;

constexpr tools::Ray along_view{{0.2F, 0.3F, 5.0F}, {0.0F, 0.0F, -1.0F}};

glm::vec3 random_direction(std::mt19937& random) {
    std::normal_distribution<float> normal;
    return glm::normalize(glm::vec3(normal(random), normal(random), normal(random)));
}

/// The nearest of all triangles, each moved to world space: what the hierarchies must find.
std::optional<float> nearest_of_all(const World& world, const tools::Ray& ray) {
    std::optional<float> nearest;
    for (auto [entity, instance] : world.view<MeshInstance>()) {
        const glm::mat4 to_world = world_matrix(world, entity);
        const Primitive& primitive = instance.mesh->primitives[0];
        const auto corner = [&](std::size_t index) {
            const auto& vertex = primitive.vertices[primitive.indices[index]];
            return glm::vec3(to_world * glm::vec4(vertex.position, 1.0F));
        };
        for (std::size_t i = 0; i < primitive.indices.size(); i += 3) {
            const Triangle triangle{corner(i), corner(i + 1), corner(i + 2)};
            const auto hit = intersect(triangle, 0, {ray.origin, ray.direction});
            if (hit && hit->t < nearest.value_or(INFINITY)) nearest = hit->t;
        }
    }
    return nearest;
}

}  // namespace

TEST_CASE("a ray meets the nearest surface, with its point, normal and distance") {
    World world;
    add_mesh(world, square(1.0F), {.translation = {0.0F, 0.0F, -2.0F}});
    const Entity near = add_mesh(world, square(1.0F), {.translation = {0.0F, 0.0F, 1.0F}});
    tools::SceneRays rays;
    rays.update_and_wait(world);
    const auto hit = rays.first_hit(along_view);
    REQUIRE(hit);
    CHECK(hit->entity == near);
    CHECK(glm::distance(hit->point, {0.2F, 0.3F, 1.0F}) < rounding);
    CHECK(glm::distance(hit->normal, {0.0F, 0.0F, 1.0F}) < rounding);
    CHECK(std::abs(hit->distance - 4.0F) < rounding);
    CHECK_FALSE(rays.first_hit(along_view, {}, 3.9F));
    CHECK_FALSE(rays.first_hit({{0.2F, 1.3F, 5.0F}, {0.0F, 0.0F, -1.0F}}));
}

TEST_CASE("what moved is found where it is now, without another hierarchy") {
    World world;
    const Entity wall = add_mesh(world, square(1.0F));
    const Entity other = add_mesh(world, world.get<MeshInstance>(wall).mesh, {.translation = {9, 9, 9}});
    tools::SceneRays rays;
    rays.update_and_wait(world);
    world.edit<Transform>(wall, [](Transform& transform) { transform.translation.x = 5.0F; });
    world.edit<Transform>(other, [](Transform& transform) { transform.translation = {0, 0, 2}; });
    rays.update(world);
    CHECK_FALSE(rays.building());
    CHECK(rays.first_hit(along_view).value().entity == other);
    world.remove<MeshInstance>(other);
    rays.update(world);
    CHECK_FALSE(rays.first_hit(along_view));
}

TEST_CASE("ignored entities and the backs of single-sided surfaces are passed") {
    World world;
    const Entity first = add_mesh(world, square(1.0F), {.translation = {0, 0, 1}});
    const Entity back =
        add_mesh(world, square(1.0F), {.rotation = glm::angleAxis(glm::pi<float>(), glm::vec3(0, 1, 0))});
    const Entity last = add_mesh(
        world, square(1.0F, true),
        {.translation = {0, 0, -1}, .rotation = glm::angleAxis(glm::pi<float>(), glm::vec3(0, 1, 0))});
    tools::SceneRays rays;
    rays.update_and_wait(world);
    CHECK(rays.first_hit(along_view).value().entity == first);
    const auto hit = rays.first_hit(along_view, std::array{first});
    REQUIRE(hit);
    CHECK(hit->entity == last);
    CHECK(hit->normal.z > 0.99F);  // towards the ray
    CHECK(rays.first_hit({{0, 0, -5}, {0, 0, 1}}, std::array{last}).value().entity == back);
}

TEST_CASE("mirrored instances show their fronts") {
    World world;
    add_mesh(world, cube(1.0F), {.scale = {-1.0F, 2.0F, 1.0F}});
    tools::SceneRays rays;
    rays.update_and_wait(world);
    const auto hit = rays.first_hit(along_view);
    REQUIRE(hit);
    CHECK(std::abs(hit->distance - 4.0F) < rounding);
    CHECK(hit->normal.z > 0.99F);
}

TEST_CASE("a segment is blocked by what is between its ends, and not by what blends") {
    World world;
    add_mesh(world, square(1.0F));
    const Entity glass = add_mesh(world, square(1.0F, false, AlphaMode::blend), {.translation = {0, 0, 2}});
    tools::SceneRays rays;
    rays.update_and_wait(world);
    CHECK(rays.blocked({0, 0, 5}, {0, 0, -1}));
    CHECK_FALSE(rays.blocked({0, 0, 5}, {0, 0, 1}));   // behind the glass
    CHECK_FALSE(rays.blocked({0, 0, 5}, {0, 0, 0}));   // on the wall
    CHECK_FALSE(rays.blocked({0, 0, -1}, {0, 0, 5}));  // through the back of the wall
    CHECK(rays.first_hit({{0, 0, 5}, {0, 0, -1}}).value().entity == glass);
}

TEST_CASE("meshes that cannot be drawn are not found") {
    World world;
    const Entity sound = add_mesh(world, square(1.0F), {.translation = {0.0F, 0.0F, -2.0F}});
    add_mesh(world, nullptr, {});
    Mesh no_material = *square(1.0F);
    no_material.primitives[0].material = nullptr;
    add_mesh(world, std::make_shared<const Mesh>(no_material), {});
    Mesh lost_index = *square(1.0F);
    lost_index.primitives[0].indices[3] = 4;  // of four vertices
    add_mesh(world, std::make_shared<const Mesh>(lost_index), {});
    tools::SceneRays rays;
    rays.update_and_wait(world);
    const auto hit = rays.first_hit(along_view);
    REQUIRE(hit);
    CHECK(hit->entity == sound);
}

TEST_CASE("random rays meet what testing every triangle meets, under parents that scale and rotate") {
    World world;
    std::mt19937 random(1);
    const Entity parent = add_skewing_parent(world);
    const auto mesh = [&] {
        Primitive primitive;
        for (int i = 0; i < 40; ++i) {
            add_side(primitive, random_direction(random), random_direction(random), random_direction(random));
        }
        return mesh_of(std::move(primitive), true);
    }();
    for (int i = 0; i < 20; ++i) {
        add_mesh(world, mesh, {.translation = 3.0F * random_direction(random), .parent = parent});
    }
    add_mesh(world, mesh, {.scale = {1.0F, 0.0F, 1.0F}, .parent = parent});  // flat: not found
    tools::SceneRays rays;
    rays.update_and_wait(world);
    world.remove<MeshInstance>(std::get<0>(*std::next(world.view<MeshInstance>().begin(), 20)));
    rays.update(world);
    int hits = 0;
    for (int i = 0; i < 500; ++i) {
        const tools::Ray ray{{1.0F, 2.0F, 3.0F}, random_direction(random)};
        const auto expected = nearest_of_all(world, ray);
        const auto found = rays.first_hit(ray);
        REQUIRE(found.has_value() == expected.has_value());
        if (!found) continue;
        ++hits;
        CHECK(std::abs(found->distance - *expected) < 1e-4F * *expected + rounding);
    }
    CHECK(hits > 100);
}

TEST_CASE("nothing is found, and nothing waits, while hierarchies are being built") {
    World world;
    Primitive primitive;
    std::mt19937 random(1);
    for (int i = 0; i < 200'000; ++i) {
        add_side(primitive, 10.0F * random_direction(random), 0.1F * random_direction(random),
                 0.1F * random_direction(random));
    }
    add_mesh(world, mesh_of(std::move(primitive)));
    const auto hits = [&](const tools::SceneRays& rays) {
        int found = 0;
        for (int i = 0; i < 100; ++i) found += rays.first_hit({{}, random_direction(random)}) ? 1 : 0;
        return found;
    };
    const auto seconds_to = [](const auto& work) {
        const auto start = std::chrono::steady_clock::now();
        work();
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    const double whole = seconds_to([&] {
        tools::SceneRays rays;
        rays.update_and_wait(world);
        CHECK(hits(rays) > 0);
    });
    const double interrupted = seconds_to([&] {
        tools::SceneRays rays;
        rays.update(world);
        CHECK(rays.building());
        CHECK(hits(rays) == 0);
    });
    // Only the part that was begun is completed, a seventh.
    CHECK(interrupted < 0.5 * whole);
}
}  // TEST_SUITE("scene rays")

}  // namespace candela::sandbox
