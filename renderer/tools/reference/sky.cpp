#include "renderer/tools/reference/sky.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "renderer/tools/reference/scattering.hpp"
#include "renderer/tools/reference/scene_content.hpp"

namespace candela::reference {

namespace {

glm::dvec3 turned(glm::dvec3 v, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return {c * v.x + s * v.z, v.y, c * v.z - s * v.x};
}

std::shared_ptr<const SkyPicture> white() {
    return std::make_shared<const SkyPicture>(SkyPicture{2, 1, {glm::vec3(1.0F), glm::vec3(1.0F)}});
}

/// The mean of the texel and its neighbours, over which its radiance spreads by interpolation.
double radiance_around(const SkyPicture& picture, std::uint32_t texel) {
    const std::uint32_t x = texel % picture.width, y = texel / picture.width;
    double sum = 0.0;
    for (std::uint32_t i = 0; i < 9; ++i) {
        const std::uint32_t column = (x + picture.width + i % 3 - 1) % picture.width;
        const std::uint32_t row = std::min(std::max(y + i / 3, 1U) - 1, picture.height - 1);
        const glm::vec3& radiance = picture.texels[std::size_t{row} * picture.width + column];
        sum += static_cast<double>(radiance.r + radiance.g + radiance.b) / 9.0;
    }
    return sum;
}

/// The light of one direction, weighted for either way in which it was found.
glm::vec3 weighted(const SceneContent& scene, const Surface& surface, glm::vec3 direction) {
    const Scattering way = scattering(surface, direction);
    if (way.density <= 0.0F || glm::dot(surface.face, direction) <= 0.0F) return glm::vec3(0.0F);
    if (scene.geometry.is_blocked(ray_from(surface, direction, scene.geometry))) return glm::vec3(0.0F);
    return scene.sky.radiance(direction) * (way.reflected / (way.density + scene.sky.density(direction)));
}

}  // namespace

SkyLight::SkyLight(const World& world) {
    for (auto [entity, environment] : world.view<Environment>()) {
        if (environment.radiance == glm::vec3(0.0F) || picture_) continue;
        scale_ = environment.radiance;
        rotation_ = environment.rotation;
        picture_ = environment.picture ? environment.picture : white();
    }
    if (!picture_) return;
    double sum = 0.0;
    for (std::uint32_t i = 0; i < picture_->texels.size(); ++i) {
        const std::uint32_t row = i / picture_->width;
        const double solid_angle = 2.0 * std::numbers::pi / picture_->width *
                                   (std::cos(std::numbers::pi * row / picture_->height) -
                                    std::cos(std::numbers::pi * (row + 1) / picture_->height));
        const double density = radiance_around(*picture_, i);
        sum += density * solid_angle;
        until_.push_back(sum);
        densities_.push_back(static_cast<float>(density));
    }
    for (double& until : until_) until /= sum;
    for (float& density : densities_) density /= static_cast<float>(sum);
}

/// From the top left corner of the picture, in texels.
glm::vec2 SkyLight::texel_at(glm::vec3 direction) const {
    const glm::dvec3 d = turned(glm::normalize(glm::dvec3(direction)), -static_cast<double>(rotation_));
    const double u = std::atan2(d.x, -d.z) / (2.0 * std::numbers::pi) + 0.5;
    const double v = std::acos(std::clamp(d.y, -1.0, 1.0)) / std::numbers::pi;
    return {static_cast<float>(u * picture_->width), static_cast<float>(v * picture_->height)};
}

glm::vec3 SkyLight::radiance(glm::vec3 direction) const {
    if (!any()) return glm::vec3(0.0F);
    const glm::vec2 at = texel_at(direction) - 0.5F;
    const int width = static_cast<int>(picture_->width), height = static_cast<int>(picture_->height);
    const int x = static_cast<int>(std::floor(at.x)), y = static_cast<int>(std::floor(at.y));
    glm::vec3 sum(0.0F);
    for (int i = 0; i < 4; ++i) {
        const int column = x + i % 2, row = y + i / 2;
        const float weight = (1.0F - std::abs(at.x - static_cast<float>(column))) *
                             (1.0F - std::abs(at.y - static_cast<float>(row)));
        const int texel = std::clamp(row, 0, height - 1) * width + (column + width) % width;
        sum += weight * picture_->texels[static_cast<std::size_t>(texel)];
    }
    return scale_ * sum;
}

glm::vec3 SkyLight::draw(glm::vec2 u) const {
    const auto wanted = static_cast<double>(u.x);
    const auto found = std::ranges::upper_bound(until_, wanted);
    const auto i = std::min<std::size_t>(static_cast<std::size_t>(found - until_.begin()), until_.size() - 1);
    const double before = i == 0 ? 0.0 : until_[i - 1];
    const double inside = std::clamp((wanted - before) / (until_[i] - before), 0.0, 1.0);
    const double azimuth = 2.0 * std::numbers::pi *
                           ((static_cast<double>(i % picture_->width) + inside) / picture_->width - 0.5);
    const std::size_t whole_row = i / picture_->width;
    const auto row = static_cast<double>(whole_row);
    // Evenly over the solid angle of the texel.
    const double upper = std::cos(std::numbers::pi * row / picture_->height),
                 lower = std::cos(std::numbers::pi * (row + 1.0) / picture_->height);
    const double y = std::clamp(upper + static_cast<double>(u.y) * (lower - upper), -1.0, 1.0);
    const double across = std::sqrt(1.0 - y * y);
    const glm::dvec3 direction(std::sin(azimuth) * across, y, -std::cos(azimuth) * across);
    return glm::vec3(turned(direction, static_cast<double>(rotation_)));
}

float SkyLight::density(glm::vec3 direction) const {
    const glm::vec2 at = texel_at(direction);
    const auto x = std::min(static_cast<std::uint32_t>(at.x), picture_->width - 1);
    const auto y = std::min(static_cast<std::uint32_t>(at.y), picture_->height - 1);
    return densities_[std::size_t{y} * picture_->width + x];
}

glm::vec3 light_of_sky(const SceneContent& scene, const Surface& surface, Sampler& sampler) {
    const glm::vec2 drawn(sampler.next(), sampler.next());
    const glm::vec2 around(sampler.next(), sampler.next());
    return weighted(scene, surface, scene.sky.draw(drawn)) +
           weighted(scene, surface, look_around(surface, around, sampler));
}

}  // namespace candela::reference
