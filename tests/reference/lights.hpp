#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "engine/ecs/world.hpp"

namespace candela::reference {

/// A light of the scene, placed in the world.
struct Light {
    enum class Kind : std::uint8_t { point, spot, directional };
    Kind kind;
    glm::vec3 position;   ///< metres
    glm::vec3 direction;  ///< unit, the way the light travels
    glm::vec3 intensity;  ///< candela; directional: lux
    float range;          ///< metres
    float solid_angle;    ///< that it shines into, of points and spots, sr
    float cone_scale;     ///< of the ramp between a spot's cones, in the cosine
    float cone_offset;
    bool casts_shadow;
};

/// What a light sends to a point where nothing is in the way.
struct Arrival {
    glm::vec3 direction;   ///< unit, towards the light
    float distance;        ///< metres to the light, infinite for directional ones
    glm::vec3 irradiance;  ///< lux on a surface that faces the light
};

[[nodiscard]] std::vector<Light> lights_of(const World& world);

/// KHR_lights_punctual: I / d², the cone's falloff and the window of a range.
[[nodiscard]] Arrival arrival(const Light& light, glm::vec3 position);

}  // namespace candela::reference
