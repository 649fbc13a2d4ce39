#pragma once

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <candela/scene/gltf.hpp>
#include <candela/scene/hierarchy.hpp>
#include "engine/bvh/bvh.hpp"

namespace candela::test {

/// An imported scene.
struct Loaded {
    World world;
    ImportReport report;

    explicit Loaded(const std::filesystem::path& path) : report(import_gltf(path, world)) {}

    [[nodiscard]] std::vector<Entity> called(const std::string& name) const {
        std::vector<Entity> found;
        for (auto [entity, is] : world.view<Name>()) {
            if (is.value == name) found.push_back(entity);
        }
        return found;
    }
    [[nodiscard]] Entity first_camera() const { return std::get<0>(*world.view<Camera>().begin()); }
    [[nodiscard]] glm::mat4 camera() const { return world_matrix(world, first_camera()); }
    [[nodiscard]] glm::vec3 position(Entity entity) const { return world_matrix(world, entity)[3]; }
};

inline void append(std::vector<Triangle>& triangles, const Primitive& primitive, const glm::mat4& matrix) {
    const auto corner = [&](std::size_t i) {
        return glm::vec3(matrix * glm::vec4(primitive.vertices[primitive.indices[i]].position, 1.0F));
    };
    for (std::size_t i = 0; i < primitive.indices.size(); i += 3) {
        triangles.push_back({corner(i), corner(i + 1), corner(i + 2)});
    }
}

/// In world space.
inline std::vector<Triangle> triangles_of(const Loaded& scene, Entity entity) {
    std::vector<Triangle> triangles;
    for (const Primitive& primitive : scene.world.get<MeshInstance>(entity).mesh->primitives) {
        append(triangles, primitive, world_matrix(scene.world, entity));
    }
    return triangles;
}

inline std::vector<Triangle> all_triangles(const Loaded& scene) {
    std::vector<Triangle> triangles;
    for (auto [entity, instance] : scene.world.view<MeshInstance>()) {
        const std::vector<Triangle> more = triangles_of(scene, entity);
        triangles.insert(triangles.end(), more.begin(), more.end());
    }
    return triangles;
}

/// The positions of all lights except directional ones.
inline std::vector<glm::vec3> light_positions(const Loaded& scene) {
    std::vector<glm::vec3> positions;
    for (auto [entity, light] : scene.world.view<PointLight>()) {
        positions.push_back(scene.position(entity));
    }
    for (auto [entity, light] : scene.world.view<SpotLight>()) {
        positions.push_back(scene.position(entity));
    }
    return positions;
}

template <class Component>
std::size_t count(const Loaded& scene) {
    std::size_t found = 0;
    for ([[maybe_unused]] auto [entity, component] : scene.world.view<Component>()) {
        ++found;
    }
    return found;
}

/// Triangles that can be intersected with rays.
struct Target {
    std::vector<Triangle> triangles;
    Bvh bvh = build_bvh(triangles);

    [[nodiscard]] std::optional<Hit> first(const glm::vec3& from, const glm::vec3& direction) const {
        return closest_hit(bvh, triangles, {.origin = from, .direction = direction});
    }
    /// Whether the first hit along the ray is on the front of a triangle.
    [[nodiscard]] bool shows_front(const glm::vec3& from, const glm::vec3& direction) const {
        const std::optional<Hit> hit = first(from, direction);
        if (!hit) return false;
        const Triangle& triangle = triangles[hit->triangle];
        const glm::vec3 normal = glm::cross(triangle.b - triangle.a, triangle.c - triangle.a);
        return glm::dot(normal, direction) < 0.0F;
    }
};

/// Directions spread evenly over the sphere: equal steps in height, golden-angle steps around it.
inline std::vector<glm::vec3> directions(int number) {
    std::vector<glm::vec3> spread;
    for (int i = 0; i < number; ++i) {
        const float height = 1.0F - (2.0F * float(i) + 1.0F) / float(number);
        const float radius = std::sqrt(1.0F - height * height);
        const float angle = 2.39996323F * float(i);
        spread.emplace_back(radius * std::cos(angle), height, radius * std::sin(angle));
    }
    return spread;
}

/// The world-space direction from the scene's first camera through a pixel centre. Not normalised: its
/// component along the view direction is 1. Row 0 is at the top.
inline glm::vec3 through_pixel(const Loaded& scene, glm::ivec2 pixel, glm::ivec2 size) {
    const Camera& camera = scene.world.get<Camera>(scene.first_camera());
    const float scale = 2.0F * std::tan(camera.vertical_fov / 2.0F) / float(size.y);
    const float x = (float(pixel.x) + 0.5F - float(size.x) / 2.0F) * scale;
    const float y = (float(size.y) / 2.0F - float(pixel.y) - 0.5F) * scale;
    return glm::mat3(scene.camera()) * glm::vec3(x, y, -1.0F);
}

}  // namespace candela::test
