#pragma once

#include <optional>
#include <string>
#include <vector>

#include <candela/ecs/world.hpp>
#include "sandbox/editing/viewport.hpp"

namespace candela::sandbox {

/// A light as it is marked in the window.
struct LightMarker {
    Entity entity;
    std::string name;
    glm::vec3 colour{1.0F};    ///< linear
    glm::vec3 position{0.0F};  ///< world space, metres
};

/// All lights that have a position, in the order of their creation.
[[nodiscard]] std::vector<LightMarker> light_markers(const World& world);

/// The marker nearest to a position in the window, if it is within `radius`; both in window coordinates.
[[nodiscard]] std::optional<Entity> pick(const std::vector<LightMarker>& markers, const Viewport& viewport,
                                         glm::vec2 position, float radius);

/// Moves an entity along the axes of the view: +x right, +y up, +z towards the viewer; in metres.
void nudge(World& world, Entity entity, const Viewport& viewport, const glm::vec3& metres);

}  // namespace candela::sandbox
