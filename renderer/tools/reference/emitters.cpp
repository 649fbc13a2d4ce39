#include "renderer/tools/reference/emitters.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "renderer/tools/reference/scattering.hpp"
#include "renderer/tools/reference/scene_content.hpp"

namespace candela::reference {

namespace {

float area_of(const Triangle& triangle) {
    const auto& [a, b, c] = triangle.corners;
    return 0.5F * glm::length(glm::cross(b.position - a.position, c.position - a.position));
}

/// The light of an emitting surface, weighted for either way in which it was found: both give the same, since
/// the density of the way itself cancels.
glm::vec3 weighted(const SceneContent& scene, const Surface& receiver, const Surface& emitter,
                   std::uint32_t triangle) {
    const Scattering way = scattering(receiver, emitter);
    return emitter.emission * (way.reflected / (way.density + scene.emitters.density(triangle)));
}

glm::vec3 by_drawing_a_point(const SceneContent& scene, const Surface& receiver, Sampler& sampler) {
    const float which = sampler.next();
    const float u = sampler.next();
    const float v = sampler.next();
    const Emitters::Draw drawn = scene.emitters.draw(which, {u, v});
    const Triangle& triangle = scene.geometry.triangle(drawn.triangle);
    const SurfaceMaterial& material = scene.geometry.material(triangle);
    if (material.is_hole(colour_at(triangle, material, drawn.weights))) return glm::vec3(0.0F);
    const glm::vec3 direction = position_at(triangle, drawn.weights) - receiver.position;
    const Surface emitter = struck_surface(scene.geometry, {0.0F, drawn.triangle, drawn.weights}, direction);
    if (emitter.emission == glm::vec3(0.0F) || !are_connected(scene.geometry, receiver, emitter)) {
        return glm::vec3(0.0F);
    }
    return weighted(scene, receiver, emitter, drawn.triangle);
}

glm::vec3 by_looking_around(const SceneContent& scene, const Surface& receiver, Sampler& sampler) {
    const float u = sampler.next();
    const float v = sampler.next();
    const glm::vec3 direction = look_around(receiver, {u, v}, sampler);
    if (glm::dot(direction, receiver.face) <= 0.0F) return glm::vec3(0.0F);
    const auto hit = scene.geometry.closest(ray_from(receiver, direction, scene.geometry));
    if (!hit) return glm::vec3(0.0F);
    const Surface emitter = struck_surface(scene.geometry, *hit, direction);
    if (emitter.emission == glm::vec3(0.0F)) return glm::vec3(0.0F);
    return weighted(scene, receiver, emitter, hit->triangle);
}

}  // namespace

Emitters::Emitters(const Geometry& geometry) : density_(geometry.triangle_count(), 0.0F) {
    double total = 0.0;
    for (std::uint32_t i = 0; i < geometry.triangle_count(); ++i) {
        const SurfaceMaterial& material = geometry.material(geometry.triangle(i));
        const float emission = material.emissive.r + material.emissive.g + material.emissive.b;
        if (emission <= 0.0F || material.alpha_mode == AlphaMode::blend) continue;
        density_[i] = emission;
        total += static_cast<double>(emission) * static_cast<double>(area_of(geometry.triangle(i)));
        sources_.push_back({i, static_cast<float>(total)});
    }
    for (float& density : density_) density /= static_cast<float>(std::max(total, 1e-30));
    for (Source& source : sources_) source.until /= static_cast<float>(total);
}

Emitters::Draw Emitters::draw(float which, glm::vec2 u) const {
    const auto found = std::ranges::upper_bound(sources_, which, {}, &Source::until);
    const Source& source = found == sources_.end() ? sources_.back() : *found;
    const float root = std::sqrt(u.x);  // uniform in the triangle
    return {source.triangle, {root * (1.0F - u.y), root * u.y}};
}

glm::vec3 light_of_emitters(const SceneContent& scene, const Surface& surface, Sampler& sampler) {
    return by_drawing_a_point(scene, surface, sampler) + by_looking_around(scene, surface, sampler);
}

}  // namespace candela::reference
