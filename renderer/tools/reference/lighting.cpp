#include "renderer/tools/reference/lighting.hpp"

#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

#include <glm/geometric.hpp>

#include "renderer/tools/reference/scattering.hpp"

namespace candela::reference {

namespace {

// Where glossy surfaces reflect a light without extent, their highlight is at least this wide.
constexpr float least_alpha_for_lights = 1.0F / 512.0F;

/// The radiance that a surface reflects of a light, without occlusion. The defects are those of Lambertian
/// surfaces.
glm::vec3 reflected(const Arrival& light, const Surface& surface, Defect defect) {
    const float cosine = glm::dot(surface.normal, light.direction);
    if (cosine <= 0.0F) return glm::vec3(0.0F);
    if (surface.bsdf) return surface.bsdf->value(light.direction, least_alpha_for_lights) * light.irradiance;
    const float weight = defect == Defect::drop_cosine ? 1.0F : cosine;
    const float spread = defect == Defect::drop_pi ? 1.0F : std::numbers::inv_pi_v<float>;
    return surface.albedo * light.irradiance * (weight * spread);
}

bool is_lit(const Geometry& geometry, const Surface& surface, const Arrival& light) {
    if (glm::dot(surface.face, light.direction) <= 0.0F) return false;  // the triangle itself is in the way
    Ray ray = ray_from(surface, light.direction, geometry);
    ray.farthest = light.distance - 2.0F * geometry.ray_offset();  // the light may be on a surface
    return !geometry.is_blocked(ray);
}

/// A light that contributes less than this share of the unoccluded light makes no visible edge: the square of
/// the share, which is the relative error of a pixel on the wrong side of the edge, is below 1e-4, the error
/// that direct light may have away from edges.
constexpr float faint_share = 0.005F;

float power_of(glm::vec3 light) {
    return light.r + light.g + light.b;
}

/// The radiance that a surface reflects of one light.
struct Reflected {
    std::uint32_t light = 0;  ///< index
    Arrival arrival{};
    glm::vec3 radiance{0.0F};
};

/// What the receiver reflects, divided by its albedo, of unit radiance from `struck`, in one sample of either
/// way: what it reflects from a unit area, divided by the sum of the densities with which both ways find
/// `struck` and the light. The density of the way itself cancels with the balance heuristic.
glm::vec3 reflected_share(const SceneContent& scene, const Surface& receiver, const Surface& struck,
                          const Reflected& light) {
    const Scattering around = scattering(receiver, struck);
    const float cosine = glm::dot(struck.face, light.arrival.direction);
    const float from_light = scene.emission.density(light.light, light.arrival, cosine);
    return around.reflected / (around.density + from_light);
}

/// Keeps the states of lights that contribute at least the faint share of the sum of `powers`.
void drop_faint(std::vector<LightState>& states, const std::vector<float>& powers) {
    const float least = faint_share * std::accumulate(powers.begin(), powers.end(), 0.0F);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < states.size(); ++i) {
        if (powers[i] >= least) states[kept++] = states[i];
    }
    states.resize(kept);
}

}  // namespace

Direct direct_light(const SceneContent& scene, const Surface& surface, Defect defect) {
    Direct direct;
    std::vector<float> powers;
    for (std::uint32_t i = 0; i < scene.lights.size(); ++i) {
        const Light& light = scene.lights[i];
        const Arrival arriving = arrival(light, surface.position);
        const glm::vec3 radiance = reflected(arriving, surface, defect);
        if (power_of(radiance) <= 0.0F) continue;
        const bool lit = !light.casts_shadow || is_lit(scene.geometry, surface, arriving);
        direct.states.push_back({i, lit});
        powers.push_back(power_of(radiance));
        if (lit) direct.radiance += radiance;
    }
    drop_faint(direct.states, powers);
    return direct;
}

glm::vec3 light_by_looking_around(const SceneContent& scene, const Surface& receiver, const Surface& struck,
                                  Sampler& sampler, Defect defect) {
    // Weighted reservoir sampling: the light kept last is drawn with a probability proportional to its power.
    Reflected drawn;
    float total = 0.0F;
    for (std::uint32_t i = 0; i < scene.lights.size(); ++i) {
        const Arrival arriving = arrival(scene.lights[i], struck.position);
        const glm::vec3 radiance = reflected(arriving, struck, defect);
        const float power = power_of(radiance);
        if (power <= 0.0F) continue;
        total += power;
        if (power == total || sampler.next() * total < power) drawn = {i, arriving, radiance};
    }
    if (total == 0.0F || !is_lit(scene.geometry, struck, drawn.arrival)) return glm::vec3(0.0F);
    const glm::vec3 share = reflected_share(scene, receiver, struck, drawn);
    return drawn.radiance * (share * total / power_of(drawn.radiance));
}

glm::vec3 light_by_looking_from_light(const SceneContent& scene, const Surface& receiver, Sampler& sampler,
                                      Defect defect) {
    if (scene.lights.empty()) return glm::vec3(0.0F);
    const glm::vec2 u = sampler.next_direction();
    const Emission::Draw drawn = scene.emission.draw(sampler.next(), u);
    const std::optional<Hit> hit = scene.geometry.closest(drawn.ray);
    if (!hit) return glm::vec3(0.0F);
    Surface struck = struck_surface(scene.geometry, *hit, drawn.ray.direction, receiver.shows_gloss);
    if (struck.bsdf) {
        struck.bsdf = struck.bsdf->seen_from(glm::normalize(receiver.position - struck.position));
    }
    Reflected light{drawn.light, arrival(scene.lights[drawn.light], struck.position), {}};
    light.radiance = reflected(light.arrival, struck, defect);
    if (power_of(light.radiance) <= 0.0F || !are_connected(scene.geometry, receiver, struck)) {
        return glm::vec3(0.0F);
    }
    return light.radiance * reflected_share(scene, receiver, struck, light);
}

}  // namespace candela::reference
