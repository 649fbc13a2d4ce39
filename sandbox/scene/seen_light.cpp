#include "sandbox/scene/seen_light.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <candela/scene/hierarchy.hpp>
#include "engine/scene/decoded.hpp"

namespace candela::sandbox {

namespace {

constexpr float pi = std::numbers::pi_v<float>;

/// Mean of the strongest channel of each texel, decoded.
float mean_of(const Image& image) {
    if (image.texels.empty()) return 0.0F;
    const std::array<double, 256> decoded = decoded_values(image.encoding);
    double sum = 0.0;
    for (const glm::u8vec4& texel : image.texels) sum += decoded[std::max({texel.r, texel.g, texel.b})];
    return static_cast<float>(sum / static_cast<double>(image.texels.size()));
}

/// Of the strongest channel.
float mean_emission(const Material& material) {
    const glm::vec3 factor = material.emissive;
    const float strongest = std::max({factor.r, factor.g, factor.b});
    if (strongest == 0.0F || !material.emissive_texture) return strongest;
    return strongest * mean_of(*material.emissive_texture);
}

/// Whether nothing is in the way between two points on surfaces or at lamps.
bool see_each_other(const tools::SceneRays& surfaces, const glm::vec3& a, const glm::vec3& b) {
    constexpr float inside = 1e-3F;  // of the way, whose ends may lie on surfaces
    const glm::vec3 start = glm::mix(a, b, inside);
    const glm::vec3 end = glm::mix(b, a, inside);
    // Surfaces block light from both sides, but only their fronts are found.
    return !surfaces.blocked(start, end) && !surfaces.blocked(end, start);
}

}  // namespace

std::vector<tools::SurfaceHit> seen_surfaces(const tools::SceneRays& surfaces, const Viewport& viewport) {
    std::vector<tools::SurfaceHit> seen;
    for (float y = 0.5F; y < viewport.size.y; ++y) {
        for (float x = 0.5F; x < viewport.size.x; ++x) {
            const auto hit = surfaces.first_hit(ray_through(viewport, viewport.origin + glm::vec2(x, y)));
            if (hit) seen.push_back(*hit);
        }
    }
    return seen;
}

LampLight::LampLight(const World& world, const tools::SceneRays& surfaces) : surfaces_(surfaces) {
    visit_lights(world, [&]<class Light>(Entity entity, const Light& light) {
        if constexpr (light_traits<Light>.has_position) {
            if (strength_of(light) * light.colour == glm::vec3(0.0F)) return;
            const glm::mat4 to_world = world_matrix(world, entity);
            float least_cosine = -1.0F;
            if constexpr (light_traits<Light>.has_direction) least_cosine = std::cos(light.outer_cone);
            lamps_.push_back(
                {to_world[3], glm::normalize(-glm::vec3(to_world[2])), light.range, least_cosine});
        }
    });
}

bool LampLight::reaches(const tools::SurfaceHit& surface) const {
    return std::ranges::any_of(lamps_, [&](const Lamp& lamp) {
        const glm::vec3 apart = surface.point - lamp.position;
        const float distance = glm::length(apart);
        return distance < lamp.range && glm::dot(apart, surface.normal) < 0.0F &&
               glm::dot(apart, lamp.axis) >= lamp.least_cosine * distance &&
               see_each_other(surfaces_, lamp.position, surface.point);
    });
}

EmittedLight::EmittedLight(const World& world, const tools::SceneRays& surfaces) : surfaces_(surfaces) {
    WorldMatrices matrices(world);
    for (const auto& [entity, instance] : world.view<MeshInstance>()) {
        for (const Primitive& primitive : instance.mesh->primitives) add(primitive, matrices(entity));
    }
    by_flux_ = {flux_.begin(), flux_.end()};
}

void EmittedLight::add(const Primitive& primitive, const glm::mat4& to_world) {
    const float radiance = mean_emission(*primitive.material);
    if (radiance == 0.0F) return;
    const auto place = [&](std::uint32_t vertex) {
        return glm::vec3(to_world * glm::vec4(primitive.vertices[vertex].position, 1.0F));
    };
    for (std::size_t i = 0; i + 2 < primitive.indices.size(); i += 3) {
        const glm::vec3 a = place(primitive.indices[i]);
        const glm::vec3 ab = place(primitive.indices[i + 1]) - a;
        const glm::vec3 ac = place(primitive.indices[i + 2]) - a;
        const float area = 0.5F * glm::length(glm::cross(ab, ac));
        if (area == 0.0F) continue;
        triangles_.push_back({a, ab, ac, primitive.material->double_sided});
        flux_.push_back(static_cast<double>(pi * radiance * area));
    }
}

/// The geometry term cos θ cos θ' / r² to a point of a triangle, both drawn in proportion to the flux; 0
/// where a surface is in the way.
float EmittedLight::draw_geometry(const glm::vec3& point, const glm::vec3& normal) {
    const EmittingTriangle& from = triangles_[by_flux_(random_)];
    const float root = std::sqrt(unit());
    const float along = unit();
    const glm::vec3 emitting = from.a + root * (1.0F - along) * from.ab + root * along * from.ac;
    const glm::vec3 apart = emitting - point;
    const float distance2 = std::max(glm::dot(apart, apart), 1e-12F);
    const glm::vec3 towards = apart / std::sqrt(distance2);
    const float leaving = -glm::dot(glm::normalize(glm::cross(from.ab, from.ac)), towards);
    const float arriving = glm::dot(normal, towards);
    if (arriving <= 0.0F || (leaving <= 0.0F && !from.double_sided)) return 0.0F;
    if (!see_each_other(surfaces_, point, emitting)) return 0.0F;
    return arriving * std::abs(leaving) / distance2;
}

float EmittedLight::on_white(const glm::vec3& point, const glm::vec3& normal, int rays) {
    if (!any()) return 0.0F;
    float sum = 0.0F;
    for (int i = 0; i < rays; ++i) sum += draw_geometry(point, normal);
    // The irradiance is that of all radiance times area, which is flux / π, and a white surface has 1/π of
    // it.
    const auto flux = static_cast<float>(std::reduce(flux_.begin(), flux_.end()));
    return flux / (pi * pi) * sum / static_cast<float>(rays);
}

}  // namespace candela::sandbox
