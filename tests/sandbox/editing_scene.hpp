#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include <candela/scene/components.hpp>

namespace candela::sandbox {

// Small worlds for the tests of editing. Lengths are in metres.

/// Appends a parallelogram with the corner `at` and these sides; its front is at the side of side × up.
inline void add_side(Primitive& primitive, const glm::vec3& at, const glm::vec3& side, const glm::vec3& up) {
    const auto first = static_cast<std::uint32_t>(primitive.vertices.size());
    const glm::vec3 normal = glm::normalize(glm::cross(side, up));
    for (const glm::vec3& corner : {at, at + side, at + side + up, at + up}) {
        primitive.vertices.push_back({corner, normal, {}});
    }
    for (const std::uint32_t corner : {0U, 1U, 2U, 0U, 2U, 3U}) primitive.indices.push_back(first + corner);
}

inline std::shared_ptr<const Mesh> mesh_of(Primitive primitive, bool double_sided = false,
                                           AlphaMode alpha = AlphaMode::opaque) {
    Material material;
    material.double_sided = double_sided;
    material.alpha_mode = alpha;
    primitive.material = std::make_shared<const Material>(std::move(material));
    const auto mesh = std::make_shared<Mesh>();
    mesh->primitives.push_back(std::move(primitive));
    return mesh;
}

/// A square in the plane z = 0 that faces +Z, from -half to half.
inline std::shared_ptr<const Mesh> square(float half, bool double_sided = false,
                                          AlphaMode alpha = AlphaMode::opaque) {
    Primitive primitive;
    add_side(primitive, {-half, -half, 0.0F}, {2.0F * half, 0.0F, 0.0F}, {0.0F, 2.0F * half, 0.0F});
    return mesh_of(std::move(primitive), double_sided, alpha);
}

/// A cube around the origin, seen from the outside.
inline std::shared_ptr<const Mesh> cube(float half) {
    Primitive primitive;
    const float side = 2.0F * half;
    for (const glm::length_t axis : {0, 1, 2}) {
        glm::vec3 u(0.0F);
        glm::vec3 v(0.0F);
        u[(axis + 1) % 3] = side;
        v[(axis + 2) % 3] = side;
        glm::vec3 across(0.0F);
        across[axis] = side;
        add_side(primitive, glm::vec3(-half), v, u);
        add_side(primitive, glm::vec3(-half) + across, u, v);
    }
    return mesh_of(std::move(primitive));
}

inline Entity add_mesh(World& world, std::shared_ptr<const Mesh> mesh, const Transform& transform = {}) {
    const Entity entity = world.create();
    world.set(entity, transform);
    world.set(entity, MeshInstance{std::move(mesh)});
    return entity;
}

inline Entity add_point_light(World& world, const glm::vec3& position, Entity parent = {}) {
    const Entity entity = world.create();
    world.set(entity, Transform{.translation = position, .parent = parent});
    world.set(entity, PointLight{});
    return entity;
}

/// A camera at `eye` that looks at `at`.
inline Entity add_eye(World& world, const glm::vec3& eye, const glm::vec3& at = glm::vec3(0.0F),
                      Camera camera = {}) {
    const Entity entity = world.create();
    const glm::quat rotation = glm::quatLookAt(glm::normalize(at - eye), glm::vec3(0.0F, 1.0F, 0.0F));
    world.set(entity, Transform{.translation = eye, .rotation = rotation});
    world.set(entity, camera);
    return entity;
}

/// A parent that is moved, rotated and scaled differently along its axes.
inline Entity add_skewing_parent(World& world) {
    const Entity entity = world.create();
    world.set(entity, Transform{.translation = {1.0F, 2.0F, 3.0F},
                                .rotation = glm::angleAxis(0.7F, glm::normalize(glm::vec3(1.0F, 2.0F, 3.0F))),
                                .scale = {2.0F, 0.5F, 1.5F}});
    return entity;
}

}  // namespace candela::sandbox
