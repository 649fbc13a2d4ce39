#include "renderer/tools/reference/surface.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "renderer/tools/reference/hemispherical_albedo.hpp"

namespace candela::reference {

namespace {

/// `direction` is that of a ray from the viewer.
void add_gloss(Surface& surface, const Gloss& gloss, glm::vec3 direction) {
    surface.albedo = glm::vec3(1.0F);
    surface.bsdf = Bsdf(gloss, surface.normal, -glm::normalize(direction));
}

/// Unit normal of the front, turned by the normal texture: glTF 2.0, section 3.9.3.
glm::vec3 bumpy_normal(const Geometry& geometry, const Triangle& triangle, glm::vec2 weights) {
    const SurfaceMaterial& material = geometry.material(triangle);
    const glm::vec3 normal = glm::normalize(normal_at(triangle, weights));
    if (!material.normal_texture) return normal;
    const glm::vec4 tangent = tangent_at(geometry.tangents(triangle), weights);
    const glm::vec3 along = glm::normalize(glm::vec3(tangent));
    const glm::vec3 upwards = tangent.w * glm::cross(normal, along);
    const glm::vec3 bump = material.bump(geometry.image_place(triangle, weights));
    const glm::vec3 turned = bump.x * along + bump.y * upwards + bump.z * normal;
    const float length = glm::length(turned);
    return length > 0.0F ? turned / length : normal;  // where texels cancel each other, there is no direction
}

/// KHR_materials_transmission of a thin wall: what the interface does not mirror passes through with the
/// colour of the surface. Schlick's Fresnel factor for the direction of the viewer, at this cosine.
glm::vec3 passing(const Gloss& gloss, float transmission, float cosine) {
    const float rest = 1.0F - std::min(cosine, 1.0F);
    const glm::vec3 mirrored = glm::mix(gloss.f0, glm::vec3(gloss.f90), std::pow(rest, 5.0F));
    return transmission * (1.0F - std::max({mirrored.r, mirrored.g, mirrored.b})) * gloss.diffuse;
}

SeenSurface seen_surface(const Geometry& geometry, const Hit& hit, glm::vec3 direction,
                         glm::vec3 light_through) {
    const Triangle& triangle = geometry.triangle(hit.triangle);
    const SurfaceMaterial& material = geometry.material(triangle);
    const ImagePlace place = geometry.image_place(triangle, hit.weights);
    const glm::vec4 colour = colour_at(triangle, material, hit.weights);
    const float side = glm::dot(triangle.front, direction) < 0.0F ? 1.0F : -1.0F;
    const float cover = material.cover(colour.a);
    const float kept = 1.0F - material.transmission;  // of the diffuse part
    SeenSurface seen{.surface = {.position = position_at(triangle, hit.weights),
                                 .face = side * triangle.front,
                                 .normal = side * bumpy_normal(geometry, triangle, hit.weights),
                                 .albedo = kept * glm::vec3(colour),
                                 .emission = material.emission(place)},
                     .weight = light_through * cover,
                     .through = glm::vec3(1.0F - cover),
                     .part = triangle.part,
                     .openness = material.openness(place)};
    Gloss gloss = material.gloss(glm::vec3(colour), place);
    if (material.transmission > 0.0F) {
        const float cosine = -glm::dot(seen.surface.normal, glm::normalize(direction));
        seen.through += cover * passing(gloss, material.transmission, std::max(cosine, 1e-3F));
    }
    gloss.diffuse *= kept;
    if (material.is_glossy) add_gloss(seen.surface, gloss, direction);
    return seen;
}

}  // namespace

std::vector<SeenSurface> seen_surfaces(const Geometry& geometry, const Ray& ray) {
    Sight sight = geometry.look(ray);
    if (sight.solid) sight.blended.push_back(*sight.solid);
    std::vector<SeenSurface> seen;
    glm::vec3 light_through(1.0F);
    for (const Hit& hit : sight.blended) {
        seen.push_back(seen_surface(geometry, hit, ray.direction, light_through));
        light_through *= seen.back().through;
    }
    return seen;
}

Surface struck_surface(const Geometry& geometry, const Hit& hit, glm::vec3 direction, bool as_it_is) {
    const Triangle& triangle = geometry.triangle(hit.triangle);
    const SurfaceMaterial& material = geometry.material(triangle);
    const bool shows_front = glm::dot(triangle.front, direction) < 0.0F;
    const glm::vec3 face = shows_front ? triangle.front : -triangle.front;
    const bool is_lit = shows_front || material.double_sided;
    const ImagePlace place = geometry.image_place(triangle, hit.weights);
    Surface surface{
        .position = position_at(triangle, hit.weights),
        .face = face,
        .normal = face,
        .albedo = is_lit ? glm::vec3(colour_at(triangle, material, hit.weights)) : glm::vec3(0.0F),
        .emission = is_lit ? material.emission(place) : glm::vec3(0.0F)};
    if (!is_lit || !material.is_glossy) return surface;
    const Gloss gloss = material.gloss(surface.albedo, place);
    if (as_it_is) {
        add_gloss(surface, gloss, direction);
    } else {
        surface.albedo = hemispherical_albedo(gloss);
    }
    return surface;
}

bool are_connected(const Geometry& geometry, const Surface& a, const Surface& b) {
    const glm::vec3 between = b.position - a.position;
    const bool face_each_other = glm::dot(a.normal, between) > 0.0F && glm::dot(a.face, between) > 0.0F &&
                                 glm::dot(b.face, between) < 0.0F;
    if (!face_each_other) return false;
    // The ray ends above `b`, too: at a slant it would otherwise hit the triangle of `b` itself.
    const float offset = geometry.ray_offset();
    const glm::vec3 origin = a.position + offset * a.face;
    const glm::vec3 way = b.position + offset * b.face - origin;
    const float share = offset / glm::length(way);
    return !geometry.is_blocked(
        {.origin = origin, .direction = way, .nearest = share, .farthest = 1.0F - share});
}

}  // namespace candela::reference
