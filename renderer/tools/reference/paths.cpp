#include "renderer/tools/reference/paths.hpp"

#include <algorithm>
#include <limits>

#include <glm/geometric.hpp>

#include "renderer/tools/reference/scattering.hpp"

namespace candela::reference {

namespace {

// Below this throughput, paths end by Russian roulette, with a survival probability proportional to it.
constexpr float little = 0.25F;
// After this many bounces, paths may end whatever their throughput: in a white room they would not end
// otherwise. The variance is finite as long as the square of the albedo is less than the survival
// probability.
constexpr std::uint32_t many_bounces = 16;
constexpr float survival_after_many = 0.999F;
// Without caustics, lobes up to this alpha (a roughness of 0.3) show glossy surfaces as they are.
constexpr float greatest_alpha_that_shows_gloss = 0.09F;

/// The next surface of a path.
struct Step {
    Surface surface;
    glm::vec3 reflected;  ///< the share of its light that the last one reflects, divided by the last albedo
};

/// Nullopt if the path leaves the scene, or if the direction points below the last surface's triangle or
/// normal.
std::optional<Step> next_step(const Geometry& geometry, const Surface& from, Sampler& sampler) {
    const glm::vec2 u = sampler.next_direction();
    const glm::vec3 direction = look_around(from, u, sampler);
    if (glm::dot(direction, from.face) <= 0.0F) return std::nullopt;
    glm::vec3 reflected(1.0F);
    if (from.bsdf) {
        const Scattering way = scattering(from, direction);
        if (way.density <= 0.0F) return std::nullopt;
        reflected = way.reflected / way.density;
    }
    const auto hit = geometry.closest(ray_from(from, direction, geometry));
    if (!hit) return std::nullopt;
    return Step{struck_surface(geometry, *hit, direction, from.shows_gloss), reflected};
}

/// Without caustics: the surface with only one part of its BSDF, drawn, so that it is known by which one the
/// path leaves. Divides the throughput by the part's probability.
void leave_by_one_part(Surface& surface, glm::vec3& carried, Sampler& sampler) {
    surface.shows_gloss = false;
    if (!surface.bsdf) return;
    const float mirror_share = surface.bsdf->mirror_share();
    const bool by_mirror = sampler.next() < mirror_share;
    carried /= by_mirror ? mirror_share : 1.0F - mirror_share;
    surface.shows_gloss = by_mirror && surface.bsdf->gloss().alpha <= greatest_alpha_that_shows_gloss;
    surface.bsdf = by_mirror ? surface.bsdf->mirror_part() : surface.bsdf->diffuse_part();
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
        if (!settings.caustics) leave_by_one_part(at, carried, sampler);
        const bool counts = settings.defect != Defect::drop_bounce || bounce > 1;
        if (counts) radiance += carried * light_by_looking_from_light(scene, at, sampler, settings.defect);
        const std::optional<Step> step = next_step(scene.geometry, at, sampler);
        if (!step) break;
        if (counts) {
            radiance += carried * light_by_looking_around(scene, at, step->surface, sampler, settings.defect);
        }
        at = step->surface;
        carried *= step->reflected * at.albedo;
        if (counts && scene.emitters.any()) radiance += carried * light_of_emitters(scene, at, sampler);
        if (counts && scene.sky.any()) radiance += carried * light_of_sky(scene, at, sampler);
    }
    return seen.albedo * radiance;
}

}  // namespace candela::reference
