#include "sandbox/editing/flying.hpp"

#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>
#include <map>

#include <glm/geometric.hpp>

namespace candela::sandbox {

namespace {

/// In view space.
const std::map<int, glm::vec3>& directions() {
    static const std::map<int, glm::vec3> table{
        {GLFW_KEY_W, {0.0F, 0.0F, -1.0F}}, {GLFW_KEY_S, {0.0F, 0.0F, 1.0F}},
        {GLFW_KEY_A, {-1.0F, 0.0F, 0.0F}}, {GLFW_KEY_D, {1.0F, 0.0F, 0.0F}},
        {GLFW_KEY_Q, {0.0F, -1.0F, 0.0F}}, {GLFW_KEY_E, {0.0F, 1.0F, 0.0F}}};
    return table;
}

bool is_shift(int key) {
    return key == GLFW_KEY_LEFT_SHIFT || key == GLFW_KEY_RIGHT_SHIFT;
}

}  // namespace

bool Flying::uses(int key) {
    return is_shift(key) || directions().contains(key);
}

void Flying::adjust_speed(float notches) {
    constexpr float most = 64.0F;
    speed_ = std::clamp(speed_ * std::pow(1.2F, notches), 1.0F / most, most);
}

glm::vec3 Flying::direction() const {
    glm::vec3 sum(0.0F);
    for (const int key : held_) {
        const auto found = directions().find(key);
        if (found != directions().end()) sum += found->second;
    }
    return sum == glm::vec3(0.0F) ? sum : glm::normalize(sum);
}

glm::vec3 Flying::motion(float seconds, float radius) const {
    constexpr float usual = 0.5F;  // radii a second
    constexpr float faster = 4.0F;
    const bool shift = std::any_of(held_.begin(), held_.end(), is_shift);
    return direction() * (usual * radius * speed_ * (shift ? faster : 1.0F) * seconds);
}

}  // namespace candela::sandbox
