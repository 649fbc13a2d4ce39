#pragma once

#include <optional>
#include <variant>

#include "sandbox/light_picking.hpp"
#include "sandbox/orbit_camera.hpp"
#include "sandbox/scene.hpp"
#include "sandbox/window.hpp"

namespace candela::sandbox {

/// Turns input into changes of the world: a camera of the viewer's own that orbits, pans and zooms, and
/// lights that are picked, dragged and nudged.
class Interaction {
 public:
    /// Adds the viewer's camera to the world, which is referred to, and looks from `camera`.
    Interaction(World& world, Entity camera);

    /// `size` is the window's, in window coordinates, each > 0.
    void handle(const InputEvent& event, glm::vec2 size);
    /// Takes over the pose and lens of a camera of the scene.
    void look_from_camera(Entity camera);

    /// The viewer's camera.
    [[nodiscard]] Entity viewer() const { return viewer_; }
    /// The camera that the viewer last started from.
    [[nodiscard]] Entity camera() const { return camera_; }

    std::optional<Entity> selected;  ///< light

    static constexpr float pick_radius = 14.0F;  ///< window coordinates

 private:
    struct Orbiting {};
    struct Panning {};

    void press(const InputEvent& event, const Viewport& viewport);
    void move(glm::vec2 position, const Viewport& viewport);
    void scroll(float notches);
    void press_key(int key, const Viewport& viewport);
    void place_viewer();
    /// Metres that a unit of the window spans at the pivot.
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
