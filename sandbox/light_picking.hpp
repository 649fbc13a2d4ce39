#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/ecs/world.hpp"
#include "sandbox/viewport.hpp"

namespace candela::sandbox {

/// A light as the window marks it.
struct LightMarker {
    Entity entity;
    std::string name;
    glm::vec3 colour{1.0F};    ///< linear
    glm::vec3 position{0.0F};  ///< world space, metres
};

/// Every light that sits somewhere: point and spot lights, in the order of their creation. Directional lights
/// have no place.
[[nodiscard]] std::vector<LightMarker> light_markers(const World& world);

/// The marker nearest to a position of the window, if it is within `radius` (window coordinates).
[[nodiscard]] std::optional<Entity> pick(const std::vector<LightMarker>& markers, const Viewport& viewport,
                                         glm::vec2 position, float radius);

/// Puts the entity's origin at a place in world space, whatever its parents are. Nothing happens below a
/// parent that is flat, where most places cannot be reached.
void move_to(World& world, Entity entity, const glm::vec3& position);

/// A light being dragged in the plane through it that faces the camera. What was grabbed stays under the
/// pointer.
class LightDrag {
 public:
    LightDrag(const World& world, const Viewport& viewport, Entity light, glm::vec2 pointer);

    [[nodiscard]] Entity light() const { return light_; }
    void drag(World& world, const Viewport& viewport, glm::vec2 pointer) const;

 private:
    Entity light_;
    glm::vec3 grabbed_at_;
    glm::vec2 offset_{0.0F};  ///< from the pointer to the light, window coordinates
};

/// Moves a light along the picture's axes: +x right, +y up, +z towards the viewer; metres.
void nudge(World& world, Entity light, const Viewport& viewport, const glm::vec3& metres);

}  // namespace candela::sandbox
