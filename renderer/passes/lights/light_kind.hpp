#pragma once

#include <algorithm>
#include <array>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <numbers>
#include <variant>
#include <vector>

#include <candela/ecs/world_reader.hpp>
#include <candela/graph/frame_graph.hpp>
#include <candela/scene/hierarchy.hpp>
#include <candela/scene/lights.hpp>
#include "renderer/passes/lights/light_table.hpp"
#include "renderer/passes/scene/scene_check.hpp"

namespace candela {

/// A sphere in world space, metres. The radius may be infinite.
struct LightBounds {
    glm::vec3 centre;
    float radius;
};

/// The map that a light's shadows need: a cube or a flat map.
struct ShadowShape {
    std::uint32_t kind = SHADOW_CUBE;
    glm::vec3 axis{0.0F};         ///< of a flat map: its viewing direction, unit
    float tangent = 0.0F;         ///< perspective: of the half angle
    glm::vec2 half_extent{0.0F};  ///< orthographic: metres
    float near = 0.0F;            ///< metres from the light to where depth is 1; orthographic: 0
    float far = 0.0F;             ///< metres from the light to where depth is 0; may be infinite
};

/// All that the CPU needs to know of a kind of light. Each kind is one C++ file, which defines one of these,
/// and one shader file: shaders/lights/point_light.glsl and its siblings.
struct LightKind {
    /// Appends the lights of this kind that are in the world and that `check` accepts.
    void (*gather)(const WorldReader& world, SceneCheck& check, const SceneMetrics& metrics,
                   std::vector<LightTable::Entry>& entries);
    /// Contains everything that the light may reach.
    LightBounds (*bounds)(const gpu::Light& light);
    ShadowShape (*shadow)(const gpu::Light& light, const SceneMetrics& metrics);
};

/// Of the widest half angle of flat maps, 60 degrees. Beyond it, most texels would cover the rim.
inline constexpr float cos_widest_map = 0.5F;

/// A length that is small in the scene, metres: the near plane of maps around a light that is in it.
[[nodiscard]] inline float least_depth(const SceneMetrics& metrics) {
    return std::max(1e-3F * metrics.radius(), 1e-9F);
}

/// A flat map that contains the scene's bounding sphere, for lights from which it is narrow enough; else a
/// cube.
[[nodiscard]] ShadowShape shadow_around(glm::vec3 position, const SceneMetrics& metrics);
/// A flat map of the cone around `axis`.
[[nodiscard]] ShadowShape shadow_in_cone(glm::vec3 position, glm::vec3 axis, float tangent,
                                         const SceneMetrics& metrics);

extern const LightKind point_light;
extern const LightKind spot_light;
extern const LightKind directional_light;

/// By gpu::Light::kind, in the order of AnyLight.
inline constexpr auto light_kinds =
    std::to_array<const LightKind*>({&point_light, &spot_light, &directional_light});
static_assert(light_kinds.size() == std::variant_size_v<AnyLight>);

inline constexpr float hemisphere = 2.0F * std::numbers::pi_v<float>;  ///< steradians

/// The direction in which a light with this local-to-world matrix shines: its local -Z axis.
[[nodiscard]] glm::vec3 direction_of(const glm::mat4& world);

/// Parallel light.
struct ParallelLight {
    glm::vec3 direction;    ///< unit, in which it travels
    glm::vec3 illuminance;  ///< lux, on a surface that faces it
    bool casts_shadow;
};
/// The entry of a directional light, whose footprint covers the scene.
[[nodiscard]] LightTable::Entry directional_entry(Entity entity, const ParallelLight& light,
                                                  const SceneMetrics& metrics);

/// Appends an entry for each light component of type C that `check` accepts: `make(entity, light,
/// world_matrix)`.
template <class C, class Make>
void gather_lights(const WorldReader& world, SceneCheck& check, std::vector<LightTable::Entry>& entries,
                   Make make) {
    WorldMatrices world_matrices(world);
    for (const auto& [entity, light] : world.view<C>()) {
        const glm::mat4 matrix = world_matrices(entity);
        if (check.accepts(world, entity, light) && check.accepts_at(world, entity, matrix)) {
            entries.push_back(make(entity, light, matrix));
        }
    }
}

}  // namespace candela
