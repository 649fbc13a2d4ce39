#pragma once

#include <optional>
#include <variant>

#include "sandbox/light_picking.hpp"
#include "sandbox/orbit_camera.hpp"
#include "sandbox/scene.hpp"
#include "sandbox/window.hpp"

namespace candela::sandbox {

/// Turns input into changes of the world: orbits, pans and zooms the viewer's own camera, and picks, drags
/// and nudges lights.
class Interaction {
 public:
    /// Adds the viewer's camera to the world and starts at the view of `camera`. Keeps a reference to the
    /// world.
    Interaction(World& world, Entity camera);

    /// `size` is the window size in window coordinates; both components > 0.
    void handle(const InputEvent& event, glm::vec2 size);
    /// Copies the pose and lens of one of the scene's cameras to the viewer's camera.
    void look_from_camera(Entity camera);

    /// The viewer's camera.
    [[nodiscard]] Entity viewer() const { return viewer_; }
    /// The scene camera that the viewer last started from.
    [[nodiscard]] Entity camera() const { return camera_; }

    std::optional<Entity> selected;  ///< a light

    static constexpr float pick_radius = 14.0F;  ///< window coordinates

 private:
    struct Orbiting {};
    struct Panning {};

    void press(const InputEvent& event, const Viewport& viewport);
    void move(glm::vec2 position, const Viewport& viewport);
    void scroll(float notches);
    void press_key(int key, const Viewport& viewport);
    void place_viewer();
    /// World-space metres per window coordinate at the distance of the pivot.
    [[nodiscard]] float metres_per_unit(const Viewport& viewport) const;

    World* world_;
    Entity viewer_;
    Entity camera_;
    Bounds scene_;
    OrbitCamera orbit_;
    glm::vec2 pointer_{0.0F};
    std::variant<std::monostate, Orbiting, Panning, LightDrag> action_;
};

}  // namespace candela::sandbox
