#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <candela/scene/hierarchy.hpp>
#include "shaders/bindings.glsl"
#include "tests/renderer/path_fixture.hpp"

TEST_SUITE("light lists") {

using namespace candela;

namespace {

/// The distance along the ray to the nearest triangle, in units of the length of its direction. Möller and
/// Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection" (1997).
std::optional<double> nearest_hit(const std::vector<Triangle>& triangles, const PixelRay& ray) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Triangle& triangle : triangles) {
        const glm::dvec3 a(triangle.a), ab = glm::dvec3(triangle.b) - a, ac = glm::dvec3(triangle.c) - a;
        const glm::dvec3 p = glm::cross(ray.direction, ac);
        const double determinant = glm::dot(ab, p);
        if (determinant == 0.0) continue;
        const glm::dvec3 from_a = ray.origin - a, q = glm::cross(from_a, ab);
        const double u = glm::dot(from_a, p) / determinant;
        const double v = glm::dot(ray.direction, q) / determinant;
        const double t = glm::dot(ac, q) / determinant;
        if (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0) nearest = std::min(nearest, t);
    }
    return nearest < std::numeric_limits<double>::infinity() ? std::optional(nearest) : std::nullopt;
}

/// The region that a light reaches: within its range and its cone.
struct Reach {
    glm::dvec3 position;
    glm::dvec3 axis{0.0};
    double range = 0.0;
    double cos_outer = -1.0;

    [[nodiscard]] bool contains(glm::dvec3 point) const {
        const glm::dvec3 away = point - position;
        const double distance = glm::length(away);
        return distance < range && glm::dot(away, axis) >= cos_outer * distance;
    }
};

std::vector<Reach> reaches_of(const World& world) {
    std::vector<Reach> reaches;
    for (const auto& [entity, light] : world.view<PointLight>()) {
        reaches.push_back({.position = world_matrix(world, entity)[3], .range = light.range});
    }
    for (const auto& [entity, light] : world.view<SpotLight>()) {
        const glm::dmat4 matrix(world_matrix(world, entity));
        reaches.push_back({.position = matrix[3],
                           .axis = -glm::normalize(glm::dvec3(matrix[2])),
                           .range = light.range,
                           .cos_outer = std::cos(static_cast<double>(light.outer_cone))});
    }
    return reaches;
}

/// The mean over all tiles of the number of lights that reach any of the surface points under a tile's
/// pixels.
double mean_lit(const Scene& scene, glm::uvec2 size, std::uint32_t tile_size) {
    const std::vector<Triangle> triangles = world_triangles(scene.world);
    const std::vector<Reach> reaches = reaches_of(scene.world);
    const auto& camera = scene.world.get<Camera>(scene.camera);
    const auto& pose = scene.world.get<Transform>(scene.camera);
    const glm::uvec2 tiles = (size + tile_size - 1U) / tile_size;
    std::vector<std::vector<bool>> lit(std::size_t{tiles.x} * tiles.y, std::vector<bool>(reaches.size()));
    for (std::uint32_t y = 0; y < size.y; ++y) {
        for (std::uint32_t x = 0; x < size.x; ++x) {
            const PixelRay ray = pixel_ray(camera, pose, size, x, y);
            const auto t = nearest_hit(triangles, ray);
            if (!t) continue;
            auto& tile = lit[y / tile_size * tiles.x + x / tile_size];
            for (std::size_t i = 0; i < reaches.size(); ++i) {
                tile[i] = tile[i] || reaches[i].contains(ray.origin + *t * ray.direction);
            }
        }
    }
    double sum = 0.0;
    for (const auto& tile : lit) {
        sum += static_cast<double>(std::ranges::count(tile, true));
    }
    return sum / static_cast<double>(lit.size());
}

}  // namespace

TEST_CASE_FIXTURE(PathFixture, "lists bounded by depth contain few lights that reach no visible surface") {
    const Scene scene = shipped_scene("hall-256");
    constexpr glm::uvec2 size{160, 120};
    const auto listed = [&](ShadingPath path) {
        Configuration configuration = direct_only();
        configuration.path = path;
        configure(configuration);
        static_cast<void>(render(scene, size));
        return renderer.report().lights.tile_mean;
    };
    const double lit = mean_lit(scene, size, renderer.configuration().lists.tile_size);
    const double bound = listed(ShadingPath::forward_plus);
    const double unbound = listed(ShadingPath::tiled_forward);
    MESSAGE("hall-256 at 160 × 120: in the mean a tile's surfaces are lit by ", lit,
            " lights; its list holds ", bound, " bound by depth (", bound / lit, " times as many) and ",
            unbound, " unbound");
    REQUIRE(lit > 1.0);
    CHECK(bound >= lit);
    CHECK(bound <= 3.0 * lit);
    CHECK(bound < unbound);
    CHECK(listed(ShadingPath::tiled_deferred) == bound);
}

TEST_CASE_FIXTURE(PathFixture, "where a work group culls a tile's list, it is the same list") {
    const Scene scene = shipped_scene("hall-256");
    constexpr glm::uvec2 size{80, 60};
    struct Shown {
        Picture picture;
        double mean = 0.0;
        std::uint32_t longest = 0;
    };
    const auto show = [&](ShadingPath path) {
        Configuration configuration = direct_only();
        configuration.path = path;
        configuration.lists.tile_size = 32;  // lists are longer than a work group
        configure(configuration);
        renderer.invalidate();
        Picture picture = render(scene, size);
        const LightReport lights = renderer.report().lights;
        return Shown{std::move(picture), lights.tile_mean, lights.tile_max};
    };
    std::vector<Shown> shown;
    for (const bool software : {true, false}) {
        pretend(renderer, software);
        for (const ShadingPath path : {ShadingPath::tiled_deferred, ShadingPath::tiled_forward}) {
            shown.push_back(show(path));
        }
    }
    for (const std::size_t i : {0U, 1U}) {
        const Shown& one_by_one = shown[i];
        const Shown& by_groups = shown[i + 2];
        REQUIRE(one_by_one.longest > CULL_GROUP);
        CHECK(by_groups.mean == one_by_one.mean);
        CHECK(by_groups.longest == one_by_one.longest);
        // Sums follow the order of the lists; a GPU's variants of the shaders may round differently.
        CHECK(worst_error(by_groups.picture, one_by_one.picture, 1e-3) < 1e-4);
    }
}

}  // TEST_SUITE("light lists")
