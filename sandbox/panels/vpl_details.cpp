#include "sandbox/panels/vpl_details.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <candela/scene/components.hpp>
#include "sandbox/editing/placing.hpp"
#include "sandbox/scene/scene.hpp"

namespace candela::sandbox {

namespace {

constexpr float above_surface = 1e-3F;  // metres

/// Towards a light, and what it sends to a surface that faces it.
struct Arriving {
    glm::vec3 from{0.0F};
    float distance = INFINITY;  ///< metres
    float lux = 0.0F;
};

/// KHR_lights_punctual: falls from 1 to 0 between the cones.
float share_in_cone(const SpotLight& light, float cosine) {
    const float outer = std::cos(light.outer_cone);
    const float ramp = std::max(std::cos(light.inner_cone) - outer, 1e-6F);
    const float share = glm::clamp((cosine - outer) / ramp, 0.0F, 1.0F);
    return share * share;
}

/// KHR_lights_punctual.
float share_in_range(float distance, float range) {
    const float x = distance / range;
    return glm::clamp(1.0F - x * x * x * x, 0.0F, 1.0F);
}

template <class Light>
Arriving arriving_at(const World& world, Entity entity, const Light& light, const glm::vec3& point) {
    const float strongest = std::max({light.colour.r, light.colour.g, light.colour.b});
    if constexpr (std::is_same_v<Light, DirectionalLight>) {
        return {-direction_of(world, entity), INFINITY, light.illuminance * strongest};
    } else {
        const glm::vec3 to_light = position_of(world, entity) - point;
        const float distance = std::max(glm::length(to_light), 1e-6F);
        Arriving arriving{
            to_light / distance, distance,
            light.intensity * strongest * share_in_range(distance, light.range) / (distance * distance)};
        if constexpr (std::is_same_v<Light, SpotLight>) {
            arriving.lux *= share_in_cone(light, glm::dot(-arriving.from, direction_of(world, entity)));
        }
        return arriving;
    }
}

/// Surfaces block light from both sides, but only their fronts are found.
bool is_blocked(const tools::SceneRays& surfaces, const glm::vec3& point, const Arriving& light) {
    if (std::isinf(light.distance)) return surfaces.first_hit({point, light.from}).has_value();
    const glm::vec3 end = point + light.from * (light.distance * 0.999F);
    return surfaces.blocked(point, end) || surfaces.blocked(end, point);
}

}  // namespace

std::vector<LightOfVpl> lights_of(const World& world, const tools::SceneRays& surfaces, const VplDot& vpl) {
    std::vector<LightOfVpl> lights;
    const glm::vec3 point = vpl.position + above_surface * vpl.normal;
    visit_lights(world, [&](Entity entity, const auto& light) {
        const Arriving arriving = arriving_at(world, entity, light, point);
        const float lux = arriving.lux * glm::dot(arriving.from, vpl.normal);
        if (lux <= 0.0F) return;
        if (light.casts_shadow && is_blocked(surfaces, point, arriving)) return;
        lights.push_back({entity, lux});
    });
    std::ranges::sort(lights, std::ranges::greater(), &LightOfVpl::illuminance);
    return lights;
}

std::vector<NearVpl> nearest_vpls(const std::vector<VplDot>& vpls, std::size_t index, std::size_t most) {
    std::vector<NearVpl> others;
    for (std::size_t i = 0; i < vpls.size(); ++i) {
        if (i != index) others.push_back({i, glm::distance(vpls[i].position, vpls[index].position)});
    }
    const auto end = others.begin() + static_cast<std::ptrdiff_t>(std::min(most, others.size()));
    std::ranges::partial_sort(others, end, {}, &NearVpl::distance);
    others.erase(end, others.end());
    return others;
}

std::optional<std::size_t> vpl_at(const std::vector<VplDot>& vpls, const glm::vec3& place) {
    const auto distance = [&](const VplDot& vpl) { return glm::distance(vpl.position, place); };
    const auto nearest = std::ranges::min_element(vpls, {}, distance);
    if (nearest == vpls.end()) return std::nullopt;
    return static_cast<std::size_t>(nearest - vpls.begin());
}

std::string details_of(const World& world, const tools::SceneRays& surfaces, const std::vector<VplDot>& vpls,
                       std::size_t index) {
    constexpr std::size_t most_lights = 6;
    constexpr std::size_t most_neighbours = 6;
    const VplDot& vpl = vpls[index];
    std::string words =
        fmt::format("at {:.3f} {:.3f} {:.3f} m\nnormal {:.2f} {:.2f} {:.2f}\nflux {:.4g} {:.4g} {:.4g} lm\n",
                    vpl.position.x, vpl.position.y, vpl.position.z, vpl.normal.x, vpl.normal.y, vpl.normal.z,
                    vpl.flux.r, vpl.flux.g, vpl.flux.b);
    if (vpl.area > 0.0F) words += fmt::format("cell {:.4g} m²\n", vpl.area);
    const std::vector<LightOfVpl> lights = lights_of(world, surfaces, vpl);
    words += lights.empty() ? "no light reaches it without bounces\n" : "light without bounces from\n";
    for (std::size_t i = 0; i < std::min(lights.size(), most_lights); ++i) {
        words += fmt::format("    {}: {:.4g} lx\n", name_of(world, lights[i].light), lights[i].illuminance);
    }
    if (lights.size() > most_lights) words += fmt::format("    and {} more\n", lights.size() - most_lights);
    words += "next to it";
    for (const NearVpl& other : nearest_vpls(vpls, index, most_neighbours)) {
        const glm::vec3& flux = vpls[other.index].flux;
        words += fmt::format("\n    VPL {}: {:.3g} m, {:.3g} {:.3g} {:.3g} lm", other.index, other.distance,
                             flux.r, flux.g, flux.b);
    }
    return words;
}

}  // namespace candela::sandbox
