#include "sandbox/scene/emitted_light.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

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

}  // namespace

EmittedLight::EmittedLight(const World& world) {
    WorldMatrices matrices(world);
    for (const auto& [entity, instance] : world.view<MeshInstance>()) {
        for (const Primitive& primitive : instance.mesh->primitives) add(primitive, matrices(entity));
    }
    if (!any()) return;
    by_flux_ = {flux_.begin(), flux_.end()};
    surfaces_.update_and_wait(world);
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
    constexpr float inside = 1e-3F;  // of the way, whose ends lie on surfaces
    const glm::vec3 start = point + inside * apart;
    const glm::vec3 end = emitting - inside * apart;
    // Surfaces block light from both sides, but only their fronts are found.
    if (surfaces_.blocked(start, end) || surfaces_.blocked(end, start)) return 0.0F;
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

float EmittedLight::lit_share(const Viewport& viewport, float least) {
    int seen = 0;
    int lit = 0;
    for (int i = 0; i < static_cast<int>(viewport.size.x * viewport.size.y); ++i) {
        const int width = static_cast<int>(viewport.size.x);
        const Ray ray = ray_through(viewport, viewport.origin + glm::vec2(i % width, i / width) + 0.5F);
        const auto hit = surfaces_.first_hit(ray);
        if (!hit) continue;
        constexpr int rays = 8;
        ++seen;
        if (on_white(hit->point, hit->normal, rays) > least) ++lit;
    }
    return seen == 0 ? 0.0F : static_cast<float>(lit) / static_cast<float>(seen);
}

}  // namespace candela::sandbox
