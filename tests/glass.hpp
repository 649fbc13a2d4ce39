#pragma once

#include <cmath>
#include <memory>
#include <utility>

#include <glm/common.hpp>

#include "tests/renderer/scene_builder.hpp"

namespace candela {

// Panes of glass in front of a wall that emits light, and closed forms of what is seen through them.

/// Radiance of the wall.
inline constexpr glm::vec3 wall_radiance{2.0F, 3.0F, 5.0F};

/// Upright at this z, facing +Z.
inline Transform upright_at(float z) {
    return {.translation = {0, 0, z}, .rotation = glm::angleAxis(1.57079633F, glm::vec3(1, 0, 0))};
}

inline Material glass(glm::vec3 colour, float transmission, float specular = 0.0F) {
    Material material;
    material.base_colour = glm::vec4(colour, 1.0F);
    material.transmission = transmission;
    material.specular = specular;
    material.roughness = 0.0F;
    return material;
}

inline Entity add_pane(World& world, float z, Material material) {
    return add(world, upright_at(z),
               MeshInstance{square(20.0F, std::make_shared<const Material>(std::move(material)))});
}

/// The wall is at z = -2, and the camera 2 m in front of the origin. It turns by `angle` (radians), around
/// the origin and around +Y; panes around the origin are then seen at this angle.
inline Scene bright_wall(float angle = 0.0F) {
    Scene scene;
    add(scene.world, upright_at(-2.0F), MeshInstance{square(50.0F, emitter(wall_radiance))});
    scene.camera = add(scene.world, looking({2.0F * std::sin(angle), 0, 2.0F * std::cos(angle)}, {0, 0, 0}),
                       Camera{.vertical_fov = 0.01F});
    return scene;
}

/// Of the light from behind, what smooth glass of index 1.5 lets through: Schlick's factor.
inline glm::dvec3 let_through(glm::vec3 colour, float transmission, float specular = 0.0F,
                              double angle = 0.0) {
    const double mirrored =
        static_cast<double>(specular) * (0.04 + 0.96 * std::pow(1.0 - std::cos(angle), 5.0));
    return glm::dvec3(colour) * (static_cast<double>(transmission) * (1.0 - mirrored));
}

}  // namespace candela
