#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <candela/ecs/world.hpp>
#include <candela/scene/components.hpp>
#include <candela/tools/scene_rays.hpp>
#include "sandbox/editing/viewport.hpp"

namespace candela::sandbox {

/// What dragging does. The axes of moving and turning are those of the world, the axes of scaling those of
/// the entity, because a scale along other axes would shear it.
enum class DragKind : std::uint8_t {
    move_in_plane,  ///< the plane through the entity that faces the camera
    move_along_axis,
    move_over_surface,  ///< onto what lies under the pointer
    turn_around_axis,
    turn_around_view,
    aim,  ///< the entity's -Z points at what lies under the pointer
    scale,
    scale_along_axis
};

/// What a drag does, along or around which axis: 0 x, 1 y, 2 z; without meaning for the other kinds.
struct DragMode {
    DragKind kind = DragKind::move_in_plane;
    int axis = 0;
    bool operator==(const DragMode&) const = default;
};

/// The world-space direction of a mode's axis, unit length; zero where the entity's scale is.
[[nodiscard]] glm::vec3 axis_of(const World& world, Entity entity, DragMode mode);

/// Drags an entity with the pointer. The grabbed point stays under the pointer. Where the view leaves the
/// motion undetermined, such as along an axis that points at the eye, the entity stays where it is.
class Drag {
 public:
    /// Grabs the entity with the pointer at a position in the window. `centre` is the point around which it
    /// is turned, in world space: its origin, except for lights without a position.
    Drag(const World& world, const Viewport& viewport, Entity entity, DragMode mode, const glm::vec3& centre,
         glm::vec2 pointer);

    [[nodiscard]] Entity entity() const { return entity_; }
    [[nodiscard]] DragMode mode() const { return mode_; }
    /// Continues from the start with another mode: brings the entity back there first.
    void set_mode(World& world, DragMode mode);

    /// Sets the entity's transform for this position of the pointer. `gap` is the height, in metres, at which
    /// something without a mesh is moved over a surface; meshes rest on it.
    void follow(World& world, const Viewport& viewport, glm::vec2 pointer, const tools::SceneRays& surfaces,
                float gap) const;

 private:
    void move_in_plane(World& world, const tools::Ray& ray) const;
    void move_along_axis(World& world, const tools::Ray& ray) const;
    void move_over_surface(World& world, const tools::Ray& ray, const tools::SceneRays& surfaces,
                           float gap) const;
    void turn_around(World& world, const tools::Ray& ray, const glm::vec3& axis) const;
    void aim_at(World& world, const tools::Ray& ray, const tools::SceneRays& surfaces) const;
    void scale_by(World& world, const glm::vec3& factors) const;
    void scale_along_axis(World& world, const tools::Ray& ray) const;

    Entity entity_;
    DragMode mode_;
    std::optional<Transform> start_;
    glm::vec3 centre_;
    glm::vec3 axis_;     ///< of the mode
    glm::vec3 forward_;  ///< of the view at the start
    tools::Ray grabbed_;
    glm::vec2 pointer_;
    std::vector<Entity> family_;      ///< surfaces that are ignored, because they move along
    std::vector<glm::vec3> corners_;  ///< of the box around the family at the start
};

}  // namespace candela::sandbox
