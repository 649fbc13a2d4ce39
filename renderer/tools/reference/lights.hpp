#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include <candela/ecs/world.hpp>

namespace candela::reference {

/// A light of the scene, placed in the world.
struct Light {
    enum class Kind : std::uint8_t { point, spot, directional };
    Kind kind;
    glm::vec3 position;   ///< metres
    glm::vec3 direction;  ///< unit, the way the light travels
    glm::vec3 intensity;  ///< candela; directional: lux
    float range;          ///< metres
    float solid_angle;    ///< of the emission of points and spots, sr
    float cone_scale;     ///< of a spot: falloff = (cosine * scale + offset)²
    float cone_offset;
    bool casts_shadow;
};

/// The light that arrives at a point without occlusion.
struct Arrival {
    glm::vec3 direction;   ///< unit, towards the light
    float distance;        ///< metres to the light, infinite for directional ones
    glm::vec3 irradiance;  ///< lux on a surface that faces the light
};

[[nodiscard]] std::vector<Light> lights_of(const World& world);

/// KHR_lights_punctual: I / d² times the cone's falloff and the window of the range.
[[nodiscard]] Arrival arrival(const Light& light, glm::vec3 position);

}  // namespace candela::reference
