#pragma once

#include <optional>
#include <string>
#include <vector>

#include <candela/ecs/world.hpp>
#include "sandbox/viewport.hpp"

namespace candela::sandbox {

/// A light as it is marked in the window.
struct LightMarker {
    Entity entity;
    std::string name;
    glm::vec3 colour{1.0F};    ///< linear
    glm::vec3 position{0.0F};  ///< world space, metres
};

/// All lights that have a position (point and spot lights), in the order of their creation.
[[nodiscard]] std::vector<LightMarker> light_markers(const World& world);

/// The marker nearest to a position in the window, if it is within `radius`; both in window coordinates.
[[nodiscard]] std::optional<Entity> pick(const std::vector<LightMarker>& markers, const Viewport& viewport,
                                         glm::vec2 position, float radius);

/// Moves the entity's origin to a world-space position, whatever its parents are. Does nothing if the
/// transform of its parents cannot be inverted.
void move_to(World& world, Entity entity, const glm::vec3& position);

/// Drags a light in the plane through the light that faces the camera. The grabbed point stays under the
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

/// Moves a light along the axes of the view: +x right, +y up, +z towards the viewer; in metres.
void nudge(World& world, Entity light, const Viewport& viewport, const glm::vec3& metres);

}  // namespace candela::sandbox
