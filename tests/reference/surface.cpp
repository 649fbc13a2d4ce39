#include "tests/reference/surface.hpp"

#include <glm/geometric.hpp>

namespace candela::reference {

namespace {

SeenSurface seen_surface(const Geometry& geometry, const Hit& hit, glm::vec3 direction, float light_through) {
    const Triangle& triangle = geometry.triangle(hit.triangle);
    const SurfaceMaterial& material = geometry.material(triangle);
    const glm::vec4 colour = material.colour(uv_at(triangle, hit.weights));
    const float side = glm::dot(triangle.front, direction) < 0.0F ? 1.0F : -1.0F;
    const float cover = material.alpha_mode == AlphaMode::blend ? colour.a : 1.0F;
    return {.surface = {.position = position_at(triangle, hit.weights),
                        .face = side * triangle.front,
                        .normal = side * glm::normalize(normal_at(triangle, hit.weights)),
                        .albedo = glm::vec3(colour)},
            .weight = light_through * cover,
            .part = triangle.part};
}

}  // namespace

std::vector<SeenSurface> seen_surfaces(const Geometry& geometry, const Ray& ray) {
    Sight sight = geometry.look(ray);
    if (sight.solid) sight.blended.push_back(*sight.solid);
    std::vector<SeenSurface> seen;
    float light_through = 1.0F;
    for (const Hit& hit : sight.blended) {
        seen.push_back(seen_surface(geometry, hit, ray.direction, light_through));
        light_through -= seen.back().weight;
    }
    return seen;
}

Surface struck_surface(const Geometry& geometry, const Hit& hit, glm::vec3 direction) {
    const Triangle& triangle = geometry.triangle(hit.triangle);
    const SurfaceMaterial& material = geometry.material(triangle);
    const bool shows_front = glm::dot(triangle.front, direction) < 0.0F;
    const glm::vec3 face = shows_front ? triangle.front : -triangle.front;
    const bool reflects = shows_front || material.double_sided;
    return {.position = position_at(triangle, hit.weights),
            .face = face,
            .normal = face,
            .albedo = reflects ? glm::vec3(material.colour(uv_at(triangle, hit.weights))) : glm::vec3(0.0F)};
}

}  // namespace candela::reference
