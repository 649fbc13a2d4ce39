#pragma once

#include <glm/vec2.hpp>

#include <candela/ecs/world.hpp>
#include "sandbox/editing/flying.hpp"
#include "sandbox/editing/orbit_camera.hpp"
#include "sandbox/editing/viewport.hpp"
#include "sandbox/scene/scene.hpp"

namespace candela::sandbox {

/// The user's own camera: an entity of the world that orbits, pans, zooms, looks around and flies. Every
/// change is there at once. Motions of the pointer are in window coordinates.
class Viewer {
 public:
    /// Adds the entity to the world and starts at the view of `camera`. Keeps a reference to the world.
    Viewer(World& world, Entity camera);

    [[nodiscard]] Entity entity() const { return entity_; }
    /// The scene camera that the view last started from.
    [[nodiscard]] Entity camera() const { return camera_; }
    [[nodiscard]] const OrbitCamera& orbit() const { return orbit_; }
    /// Of the scene as it was last framed as a whole; metres, > 0.
    [[nodiscard]] float scene_radius() const { return scene_.radius; }

    /// Copies the pose and lens of one of the scene's cameras.
    void look_from_camera(Entity camera);
    /// Back to the scene's camera, if it is still there.
    void reset();

    /// The grabbed point follows the pointer; over the picture's height, by 180 degrees.
    void orbit_by(glm::vec2 motion, const Viewport& viewport);
    /// The grabbed point of the pivot's plane follows the pointer.
    void pan_by(glm::vec2 motion, const Viewport& viewport);
    void look_by(glm::vec2 motion, const Viewport& viewport);
    /// Positive notches zoom in.
    void zoom_by(float notches);
    /// Shows a sphere as a whole; a radius of 0 counts as a small one. `aspect` is width / height.
    void frame(Bounds sphere, float aspect);
    void frame_scene(float aspect);

    /// Which keys are held.
    [[nodiscard]] Flying& flying() { return flying_; }
    [[nodiscard]] bool moving() const { return flying_.moving(); }
    /// Flies for this time, at most a tenth of a second, so that a pause is no leap.
    void step(float seconds);

 private:
    void place();

    World* world_;
    Entity entity_;
    Entity camera_;
    Bounds scene_;
    OrbitCamera orbit_;
    Flying flying_;
};

}  // namespace candela::sandbox
