#pragma once

#include <limits>
#include <variant>

#include <glm/vec3.hpp>

#include <candela/ecs/world_reader.hpp>

namespace candela {

/// What code that treats all kinds of lights alike knows of the kind `Light`, whose components have members
/// `colour` and `casts_shadow` too.
template <class Light>
struct LightTraits {
    const char* name;               ///< "point light"
    float Light::*strength;         ///< multiplied by `colour`
    const char* strength_name;      ///< "intensity"
    const char* unit;               ///< of the strength: "candela" or "lux"
    bool has_position;              ///< the light is where the entity is; otherwise infinitely far away
    bool has_direction;             ///< the light shines along the entity's -Z; otherwise everywhere
    float Light::*range = nullptr;  ///< null: it reaches everywhere
};

/// Defined for each kind of light, with the component.
template <class Light>
extern const LightTraits<Light> light_traits;

/// Isotropic point light at the entity's origin. Its intensity does not scale with the transform.
struct PointLight {
    glm::vec3 colour{1.0F};  ///< linear, multiplies `intensity`
    float intensity = 1.0F;  ///< candela
    /// Metres; the light falls to zero at this distance (KHR_lights_punctual).
    float range = std::numeric_limits<float>::infinity();
    bool casts_shadow = true;
    bool operator==(const PointLight&) const = default;
};
template <>
inline constexpr LightTraits<PointLight> light_traits<PointLight>{.name = "point light",
                                                                  .strength = &PointLight::intensity,
                                                                  .strength_name = "intensity",
                                                                  .unit = "candela",
                                                                  .has_position = true,
                                                                  .has_direction = false,
                                                                  .range = &PointLight::range};

/// Spot light at the entity's origin along its -Z.
struct SpotLight {
    glm::vec3 colour{1.0F};                                ///< linear, multiplies `intensity`
    float intensity = 1.0F;                                ///< candela, inside the inner cone
    float range = std::numeric_limits<float>::infinity();  ///< metres
    float inner_cone = 0.0F;                               ///< radians from the axis, < outer_cone
    float outer_cone = 0.785398163F;                       ///< radians from the axis, <= pi/2
    bool casts_shadow = true;
    bool operator==(const SpotLight&) const = default;
};
template <>
inline constexpr LightTraits<SpotLight> light_traits<SpotLight>{.name = "spot light",
                                                                .strength = &SpotLight::intensity,
                                                                .strength_name = "intensity",
                                                                .unit = "candela",
                                                                .has_position = true,
                                                                .has_direction = true,
                                                                .range = &SpotLight::range};

/// Parallel light travelling along the entity's -Z.
struct DirectionalLight {
    glm::vec3 colour{1.0F};    ///< linear, multiplies `illuminance`
    float illuminance = 1.0F;  ///< lux, on a surface that faces the light
    bool casts_shadow = true;
    bool operator==(const DirectionalLight&) const = default;
};
template <>
inline constexpr LightTraits<DirectionalLight> light_traits<DirectionalLight>{
    .name = "directional light",
    .strength = &DirectionalLight::illuminance,
    .strength_name = "illuminance",
    .unit = "lux",
    .has_position = false,
    .has_direction = true};

/// A light of any kind. This is the list of the kinds, in the order in which functions below visit them.
using AnyLight = std::variant<PointLight, SpotLight, DirectionalLight>;

/// Calls `visit(const LightTraits<Light>&)` for each kind.
template <class Visit>
constexpr void for_each_light_kind(Visit&& visit) {
    const auto call = [&]<class... Lights>(const std::variant<Lights...>* /*of_kinds*/) {
        (visit(light_traits<Lights>), ...);
    };
    call(static_cast<const AnyLight*>(nullptr));
}

/// Calls `visit(Entity, const Light&)` for each light in the world, kind by kind.
template <class Visit>
void visit_lights(const WorldReader& world, Visit&& visit) {
    for_each_light_kind([&]<class Light>(const LightTraits<Light>&) {
        for (const auto& [entity, light] : world.view<Light>()) {
            visit(entity, light);
        }
    });
}

/// Calls `visit(const Light&)` for each light of the entity, which may have one of each kind.
template <class Visit>
void visit_lights_of(const WorldReader& world, Entity entity, Visit&& visit) {
    for_each_light_kind([&]<class Light>(const LightTraits<Light>&) {
        if (const auto* const light = world.find<Light>(entity)) visit(*light);
    });
}

/// Calls `edit(Light&)` for each light of the entity.
template <class Edit>
void edit_lights_of(World& world, Entity entity, Edit&& edit) {
    for_each_light_kind([&]<class Light>(const LightTraits<Light>&) {
        if (world.has<Light>(entity)) world.edit<Light>(entity, edit);
    });
}

/// The strength of a light, in the unit of its kind.
template <class Light>
[[nodiscard]] constexpr float strength_of(const Light& light) {
    return light.*light_traits<Light>.strength;
}
template <class Light>
[[nodiscard]] constexpr float& strength_of(Light& light) {
    return light.*light_traits<Light>.strength;
}

}  // namespace candela
