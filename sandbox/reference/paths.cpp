#include "sandbox/reference/paths.hpp"

#include <algorithm>
#include <limits>

#include <glm/geometric.hpp>

namespace candela::reference {

namespace {

// Below this throughput, paths end by Russian roulette, with a survival probability proportional to it.
constexpr float little = 0.25F;
// After this many bounces, paths may end whatever their throughput: in a white room they would not end
// otherwise.
constexpr std::uint32_t many_bounces = 16;
constexpr float survival_after_many = 0.9F;

/// The next surface of a path; nullopt if the path leaves the scene, or if the direction around the mesh's
/// normal points below the triangle.
std::optional<Surface> next_surface(const Geometry& geometry, const Surface& from, Sampler& sampler) {
    const glm::vec3 direction = cosine_direction(from.normal, sampler.next_direction());
    if (glm::dot(direction, from.face) <= 0.0F) return std::nullopt;
    const auto hit = geometry.closest(ray_from(from, direction, geometry));
    return hit ? std::optional(struck_surface(geometry, *hit, direction)) : std::nullopt;
}

/// Ends the path (false), or divides its throughput by the probability of survival.
bool survives(glm::vec3& carried, std::uint32_t bounce, Sampler& sampler) {
    const float largest = std::max({carried.r, carried.g, carried.b});
    const float survival = std::min(largest / little, bounce > many_bounces ? survival_after_many : 1.0F);
    if (survival < 1.0F && sampler.next() >= survival) return false;
    carried /= survival;
    return true;
}

}  // namespace

glm::vec3 indirect_light(const SceneContent& scene, const Surface& seen, Sampler& sampler,
                         const Settings& settings) {
    const std::uint32_t last = settings.bounces.value_or(std::numeric_limits<std::uint32_t>::max());
    glm::vec3 radiance(0.0F);
    glm::vec3 carried(1.0F);
    Surface at = seen;
    for (std::uint32_t bounce = 1; bounce <= last; ++bounce) {
        if (!survives(carried, bounce, sampler)) break;
        const bool counts = settings.defect != Defect::drop_bounce || bounce > 1;
        if (counts) radiance += carried * light_by_looking_from_light(scene, at, sampler, settings.defect);
        const std::optional<Surface> struck = next_surface(scene.geometry, at, sampler);
        if (!struck) break;
        if (counts) {
            radiance += carried * light_by_looking_around(scene, at, *struck, sampler, settings.defect);
        }
        at = *struck;
        carried *= at.albedo;
        if (counts && scene.emitters.any()) radiance += carried * light_of_emitters(scene, at, sampler);
        if (counts && scene.sky.any()) radiance += carried * light_of_sky(scene, at, sampler);
    }
    return seen.albedo * radiance;
}

}  // namespace candela::reference
