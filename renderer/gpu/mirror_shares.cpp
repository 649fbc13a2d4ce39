#include "renderer/gpu/mirror_shares.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <numbers>

namespace candela {
namespace {

/// Samples along a side of a square of samples.
constexpr int side = 32;

float middle_of(int i, int count) {
    return (static_cast<float>(i) + 0.5F) / static_cast<float>(count);
}

/// Schlick's weight of the reflectance at grazing angles.
float grazing(float cosine) {
    const float rest = 1.0F - std::clamp(cosine, 0.0F, 1.0F);
    const float square = rest * rest;
    return square * square * rest;
}

/// Smith's Λ of GGX.
float masking(float cosine, float alpha) {
    const float tangent2 = (1.0F - cosine * cosine) / (cosine * cosine);
    return 0.5F * (std::sqrt(1.0F + alpha * alpha * tangent2) - 1.0F);
}

/// The directions around which microfacets are seen, the last one that of the viewer as stretched: Heitz,
/// "Sampling the GGX Distribution of Visible Normals", JCGT 2018.
glm::mat3 stretched_frame(const glm::vec3& viewer, float alpha) {
    const glm::vec3 stretched = glm::normalize(glm::vec3(alpha * viewer.x, alpha * viewer.y, viewer.z));
    const float across = std::hypot(stretched.x, stretched.y);
    const glm::vec3 first =
        across > 0.0F ? glm::vec3(-stretched.y, stretched.x, 0.0F) / across : glm::vec3(1.0F, 0.0F, 0.0F);
    return {first, glm::cross(stretched, first), stretched};
}

/// The normal of a microfacet that the viewer sees, in the space where the surface's normal is +Z, for a
/// point of the unit disc.
glm::vec3 visible_facet(const glm::mat3& frame, float alpha, const glm::vec2& point) {
    const float share = 0.5F * (1.0F + frame[2].z);
    const float rest = std::max(1.0F - point.x * point.x, 0.0F);
    const float y = (1.0F - share) * std::sqrt(rest) + share * point.y;
    const float z = std::sqrt(std::max(rest - y * y, 0.0F));
    const glm::vec3 facet = frame * glm::vec3(point.x, y, z);
    return glm::normalize(glm::vec3(alpha * facet.x, alpha * facet.y, std::max(facet.z, 0.0F)));
}

/// Points all over the unit disc, each of the same area.
std::vector<glm::vec2> make_disc() {
    std::vector<glm::vec2> points;
    for (int i = 0; i < side * side; ++i) {
        const float radius = std::sqrt(middle_of(i % side, side));
        const float angle = 2.0F * std::numbers::pi_v<float> * middle_of(i / side, side);
        points.push_back(radius * glm::vec2(std::cos(angle), std::sin(angle)));
    }
    return points;
}

const std::vector<glm::vec2>& disc() {
    static const std::vector<glm::vec2> points = make_disc();
    return points;
}

glm::vec3 viewer_at(float cosine) {
    return {std::sqrt(1.0F - cosine * cosine), 0.0F, cosine};
}

/// x and y of mirror_shares.
glm::vec2 mirror_part(const glm::vec3& viewer, float roughness) {
    const float alpha = std::max(roughness * roughness, 1e-4F);
    const float masked = masking(viewer.z, alpha);
    const glm::mat3 frame = stretched_frame(viewer, alpha);
    glm::vec2 sum(0.0F);
    for (const glm::vec2& point : disc()) {
        const glm::vec3 facet = visible_facet(frame, alpha, point);
        const float cosine = glm::dot(facet, viewer);
        const float height = 2.0F * cosine * facet.z - viewer.z;  // of the reflected direction
        if (height <= 0.0F) continue;
        const float unshadowed = (1.0F + masked) / (1.0F + masked + masking(height, alpha));
        const float weight = grazing(cosine);
        sum += unshadowed * glm::vec2(1.0F - weight, weight);
    }
    return sum / static_cast<float>(side * side);
}

/// z of mirror_shares. Directions above points of the disc, each of the same area, are those of a Lambertian
/// surface.
float diffuse_part(const glm::vec3& viewer) {
    float sum = 0.0F;
    for (const glm::vec2& point : disc()) {
        const glm::vec3 light(point, std::sqrt(std::max(1.0F - glm::dot(point, point), 0.0F)));
        sum += grazing(glm::dot(glm::normalize(light + viewer), viewer));
    }
    return sum / static_cast<float>(side * side);
}

/// A value of the table's row or column.
float value_of(std::size_t index) {
    constexpr auto last = static_cast<float>(mirror_table_size - 1);
    return static_cast<float>(index) / last;
}

std::vector<glm::vec3> make_table() {
    constexpr float least_cosine = 1e-3F;
    std::vector<glm::vec3> viewers;
    std::vector<float> diffuse;  // the same at any roughness
    for (std::size_t column = 0; column < mirror_table_size; ++column) {
        viewers.push_back(viewer_at(std::max(value_of(column), least_cosine)));
        diffuse.push_back(diffuse_part(viewers.back()));
    }
    std::vector<glm::vec3> table;
    for (std::size_t i = 0; i < std::size_t{mirror_table_size} * mirror_table_size; ++i) {
        const std::size_t column = i % mirror_table_size;
        table.emplace_back(mirror_part(viewers[column], value_of(i / mirror_table_size)), diffuse[column]);
    }
    return table;
}

}  // namespace

glm::vec3 mirror_shares(float cosine, float roughness) {
    const glm::vec3 viewer = viewer_at(cosine);
    return {mirror_part(viewer, roughness), diffuse_part(viewer)};
}

glm::vec3 mean_mirror_shares(float roughness) {
    const float row = roughness * (mirror_table_size - 1);
    const auto lower = static_cast<std::size_t>(row);
    const std::size_t upper = std::min<std::size_t>(lower + 1, mirror_table_size - 1);
    glm::vec3 sum(0.0F);
    float weights = 0.0F;
    for (std::size_t i = 0; i < mirror_table_size; ++i) {
        const glm::vec3& below = mirror_table()[lower * mirror_table_size + i];
        const glm::vec3& above = mirror_table()[upper * mirror_table_size + i];
        // The trapezoidal rule; at 0 the weight is 0 anyway.
        const float weight = value_of(i) * (i + 1 == mirror_table_size ? 0.5F : 1.0F);
        sum += weight * glm::mix(below, above, row - static_cast<float>(lower));
        weights += weight;
    }
    return sum / weights;
}

const std::vector<glm::vec3>& mirror_table() {
    static const std::vector<glm::vec3> table = make_table();
    return table;
}

}  // namespace candela
