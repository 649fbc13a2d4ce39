#include "renderer/gpu/mirror_shares.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
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
    return std::pow(1.0F - std::clamp(cosine, 0.0F, 1.0F), 5.0F);
}

/// Smith's Λ of GGX.
float masking(float cosine, float alpha) {
    const float tangent2 = (1.0F - cosine * cosine) / (cosine * cosine);
    return 0.5F * (std::sqrt(1.0F + alpha * alpha * tangent2) - 1.0F);
}

/// The normal of a microfacet that the viewer sees, in the space where the surface's normal is +Z: Heitz,
/// "Sampling the GGX Distribution of Visible Normals", JCGT 2018.
glm::vec3 visible_facet(const glm::vec3& viewer, float alpha, float u, float v) {
    const glm::vec3 stretched = glm::normalize(glm::vec3(alpha * viewer.x, alpha * viewer.y, viewer.z));
    const float across = std::hypot(stretched.x, stretched.y);
    const glm::vec3 first =
        across > 0.0F ? glm::vec3(-stretched.y, stretched.x, 0.0F) / across : glm::vec3(1.0F, 0.0F, 0.0F);
    const glm::vec3 second = glm::cross(stretched, first);
    const float radius = std::sqrt(u);
    const float angle = 2.0F * std::numbers::pi_v<float> * v;
    const float x = radius * std::cos(angle);
    const float share = 0.5F * (1.0F + stretched.z);
    const float y =
        (1.0F - share) * std::sqrt(std::max(1.0F - x * x, 0.0F)) + share * radius * std::sin(angle);
    const float z = std::sqrt(std::max(1.0F - x * x - y * y, 0.0F));
    const glm::vec3 facet = x * first + y * second + z * stretched;
    return glm::normalize(glm::vec3(alpha * facet.x, alpha * facet.y, std::max(facet.z, 0.0F)));
}

/// x and y of mirror_shares.
glm::vec2 mirror_part(const glm::vec3& viewer, float roughness) {
    const float alpha = std::max(roughness * roughness, 1e-4F);
    const float masked = masking(viewer.z, alpha);
    glm::vec2 sum(0.0F);
    for (int i = 0; i < side * side; ++i) {
        const glm::vec3 facet =
            visible_facet(viewer, alpha, middle_of(i % side, side), middle_of(i / side, side));
        const float cosine = glm::dot(facet, viewer);
        const float height = 2.0F * cosine * facet.z - viewer.z;  // of the reflected direction
        if (height <= 0.0F) continue;
        const float unshadowed = (1.0F + masked) / (1.0F + masked + masking(height, alpha));
        const float weight = grazing(cosine);
        sum += unshadowed * glm::vec2(1.0F - weight, weight);
    }
    return sum / static_cast<float>(side * side);
}

/// z of mirror_shares.
float diffuse_part(const glm::vec3& viewer) {
    float sum = 0.0F;
    for (int i = 0; i < side * side; ++i) {
        const float u = middle_of(i % side, side);
        const float angle = 2.0F * std::numbers::pi_v<float> * middle_of(i / side, side);
        const glm::vec3 light(std::sqrt(u) * std::cos(angle), std::sqrt(u) * std::sin(angle),
                              std::sqrt(1.0F - u));
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
    std::vector<glm::vec3> table;
    for (std::size_t i = 0; i < std::size_t{mirror_table_size} * mirror_table_size; ++i) {
        const float cosine = std::max(value_of(i % mirror_table_size), least_cosine);
        table.push_back(mirror_shares(cosine, value_of(i / mirror_table_size)));
    }
    return table;
}

}  // namespace

glm::vec3 mirror_shares(float cosine, float roughness) {
    const glm::vec3 viewer(std::sqrt(1.0F - cosine * cosine), 0.0F, cosine);
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
