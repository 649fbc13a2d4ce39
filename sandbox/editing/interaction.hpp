#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <glm/vec2.hpp>

#include <candela/ecs/world.hpp>
#include <candela/tools/scene_rays.hpp>
#include "sandbox/editing/drag.hpp"
#include "sandbox/editing/enclosed_lights.hpp"
#include "sandbox/editing/gizmo.hpp"
#include "sandbox/editing/history.hpp"
#include "sandbox/editing/key_bindings.hpp"
#include "sandbox/editing/light_labels.hpp"
#include "sandbox/editing/objects.hpp"
#include "sandbox/editing/viewer.hpp"
#include "sandbox/window/window.hpp"

namespace candela::sandbox {

/// An action that the app must carry out.
struct Command {
    Action action = Action::cancel;
    int number = 0;  ///< of Action::preset: 1 to 9
    bool operator==(const Command&) const = default;
};

/// What is drawn over the picture.
struct Overlay {
    std::vector<LightLabel> lights;
    std::optional<Gizmo> gizmo;
    std::optional<std::size_t> active;  ///< the handle of the gizmo that is hovered or dragged
    std::vector<glm::vec2> others;      ///< window positions of what is selected besides
};

/// Turns input into changes of the world: moves the viewer's camera; selects, drags, adds, copies and deletes
/// lights and objects; undoes and redoes that.
///
/// A press on a handle of the gizmo or on the marker of a light grabs it. A press elsewhere orbits, if the
/// pointer moves; otherwise it is a click, which selects the surface there, or nothing. With Ctrl, lights and
/// surfaces are selected besides others, or no more.
class Interaction {
 public:
    /// Adds the viewer's camera to the world and starts at the view of `camera`. Keeps a reference to the
    /// world.
    Interaction(World& world, Entity camera);

    /// The picture fills the rectangle with this size and upper left corner of the window; window
    /// coordinates. Returns what the app must do.
    std::optional<Command> handle(const InputEvent& event, glm::vec2 size,
                                  glm::vec2 origin = glm::vec2(0.0F));
    /// For menus and buttons. Returns false if the app must carry it out.
    bool carry_out(Action action);
    /// Call this in each frame, with the seconds since the last one: flies, and searches the surfaces that
    /// are ready by now.
    void step(float seconds, glm::vec2 size, glm::vec2 origin = glm::vec2(0.0F));
    /// Whether `step` must be called again soon, even without input.
    [[nodiscard]] bool moving() const { return viewer_.moving() || surfaces_.building(); }

    /// `pointer_here` tells whether the pointer is over the picture, and not over a panel.
    [[nodiscard]] Overlay overlay(const Viewport& viewport, bool pointer_here) const;

    /// Copies the pose and lens of one of the scene's cameras to the viewer's camera.
    void look_from_camera(Entity camera) { viewer_.look_from_camera(camera); }
    /// The viewer's camera.
    [[nodiscard]] Entity viewer() const { return viewer_.entity(); }
    /// The scene camera that the viewer last started from.
    [[nodiscard]] Entity camera() const { return viewer_.camera(); }
    [[nodiscard]] History& history() { return history_; }
    [[nodiscard]] const History& history() const { return history_; }
    [[nodiscard]] const tools::SceneRays& surfaces() const { return surfaces_; }
    /// The lights inside closed objects, at the last step.
    [[nodiscard]] const std::vector<EnclosedLight>& enclosed() const { return enclosed_; }
    /// The entity that is being dragged.
    [[nodiscard]] std::optional<Entity> dragged() const;
    /// Waits until clicks find all surfaces.
    void wait_for_surfaces() { surfaces_.update_and_wait(*world_); }

    /// Whatever is selected, `selected` first: lights and objects that are moved, copied and deleted
    /// together.
    [[nodiscard]] std::vector<Entity> all_selected() const;
    /// Selects it besides the others, or no more.
    void toggle(Entity entity);

    /// A light or an object, to which the tools belong. Setting it to another one selects that alone.
    std::optional<Entity> selected;
    Tool tool = Tool::move;
    float unit = 1.0F;  ///< window coordinates per unit of the user interface

    // In units of the user interface.
    static constexpr float pick_radius = 14.0F;    ///< around the marker of a light
    static constexpr float handle_radius = 8.0F;   ///< around a handle
    static constexpr float gizmo_size = 80.0F;     ///< length of an axis
    static constexpr float click_distance = 3.0F;  ///< a pointer that moves farther does not click

 private:
    struct Orbiting {
        glm::vec2 pressed_at;
        bool moved = false;
    };
    struct Panning {};
    struct Looking {};
    struct Dragging {
        Drag drag;
        glm::vec2 pressed_at;
        bool moved = false;
        glm::vec3 from{0.0F};                                ///< where the dragged entity was
        std::vector<std::pair<Entity, glm::vec3>> others{};  ///< that move along, and where they were
    };
    /// What is selected besides `first`, if that is still `selected`.
    struct Others {
        Entity first;
        std::vector<Entity> entities;
    };

    void find_enclosed();
    void press(const InputEvent& event, const Viewport& viewport);
    void press_left(const Viewport& viewport);
    void release(const InputEvent& event, const Viewport& viewport);
    void move(glm::vec2 position, const Viewport& viewport);
    void scroll(float notches);
    std::optional<Command> press_key(const InputEvent& event, const Viewport& viewport);

    void grab(Entity entity, DragMode mode, const Viewport& viewport);
    void drag(Dragging& dragging, const Viewport& viewport);
    void start(Dragging& dragging);
    void move_others(const Dragging& dragging);
    void select(const std::vector<Entity>& entities);
    [[nodiscard]] std::vector<Entity> selected_roots() const;
    void constrain(int axis);
    void click(const Viewport& viewport);
    void end_gesture();
    bool cancel();

    void nudge_selected(int key, const Viewport& viewport);
    void select_touched(const std::vector<Entity>& touched);
    void add(const AnyLight& light);
    void copy_selected();
    void remove_selected();
    void frame_selected();

    [[nodiscard]] Viewport viewport() const;
    [[nodiscard]] bool far_from(glm::vec2 pressed_at) const;
    [[nodiscard]] glm::vec3 centre_of(Entity entity) const;
    [[nodiscard]] DragMode marker_mode(Entity light) const;
    [[nodiscard]] std::optional<Gizmo> gizmo(const Viewport& viewport) const;

    World* world_;
    Viewer viewer_;
    History history_;
    tools::SceneRays surfaces_;
    std::vector<EnclosedLight> enclosed_;
    std::optional<Tick> searched_at_;  ///< the world's revision when `enclosed_` was found
    glm::vec2 size_{1.0F};
    glm::vec2 origin_{0.0F};
    glm::vec2 pointer_{0.0F};
    int button_ = 0;        ///< that began the gesture
    bool toggles_ = false;  ///< the gesture began with Ctrl
    Others others_;
    std::variant<std::monostate, Orbiting, Panning, Looking, Dragging> gesture_;
};

}  // namespace candela::sandbox
