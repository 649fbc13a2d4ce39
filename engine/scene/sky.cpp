#include <algorithm>
#include <cmath>
#include <numbers>

#include <candela/scene/components.hpp>

namespace candela {

namespace {

constexpr float pi = std::numbers::pi_v<float>;

}  // namespace

Environment environment_of(const WorldReader& world,
                           const std::function<bool(Entity, const Environment&)>& accepts) {
    for (const auto& [entity, environment] : world.view<Environment>()) {
        const bool shines = environment.radiance != glm::vec3(0.0F);
        if (shines && (!accepts || accepts(entity, environment))) return environment;
    }
    return {};
}

glm::vec3 sky_direction(glm::vec2 at) {
    const float azimuth = 2.0F * pi * (at.x - 0.5F);
    const float polar = pi * at.y;
    return {std::sin(azimuth) * std::sin(polar), std::cos(polar), -std::cos(azimuth) * std::sin(polar)};
}

glm::vec2 sky_position(glm::vec3 direction) {
    const float azimuth = std::atan2(direction.x, -direction.z);
    const float polar = std::acos(std::clamp(direction.y, -1.0F, 1.0F));
    return {azimuth / (2.0F * pi) + 0.5F, polar / pi};
}

}  // namespace candela
