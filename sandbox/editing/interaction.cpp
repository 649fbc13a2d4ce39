#include "sandbox/editing/interaction.hpp"

#include <GLFW/glfw3.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>
#include <variant>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <candela/scene/components.hpp>
#include "sandbox/candela_private.hpp"
#include "sandbox/editing/light_picking.hpp"
#include "sandbox/editing/placing.hpp"

namespace candela::sandbox {

namespace {

// Relative to the scene's radius.
constexpr float nudge_step = 0.02F;
constexpr float surface_gap = 0.03F;   // of a light that moves over surfaces
constexpr float copy_offset = 0.05F;   // to the side, of a light
constexpr float light_height = 0.3F;   // of a new light over the surface in the middle of the picture
constexpr float light_radius = 0.15F;  // of a light that is framed

/// The direction of a key in view space: +x right, +y up, +z towards the viewer.
glm::vec3 direction_of_key(int key) {
    switch (key) {
        case GLFW_KEY_LEFT:
            return {-1.0F, 0.0F, 0.0F};
        case GLFW_KEY_RIGHT:
            return {1.0F, 0.0F, 0.0F};
        case GLFW_KEY_DOWN:
            return {0.0F, -1.0F, 0.0F};
        case GLFW_KEY_UP:
            return {0.0F, 1.0F, 0.0F};
        case GLFW_KEY_PAGE_UP:
            return {0.0F, 0.0F, -1.0F};
        case GLFW_KEY_PAGE_DOWN:
            return {0.0F, 0.0F, 1.0F};
        default:
            return glm::vec3(0.0F);
    }
}

bool flies(const InputEvent& event) {
    constexpr int others = GLFW_MOD_CONTROL | GLFW_MOD_ALT | GLFW_MOD_SUPER;
    return (event.modifiers & others) == 0 && Flying::uses(event.code);
}

std::string_view verb_of(DragKind kind) {
    switch (kind) {
        case DragKind::turn_around_axis:
        case DragKind::turn_around_view:
            return "turn ";
        case DragKind::aim:
            return "aim ";
        case DragKind::scale:
        case DragKind::scale_along_axis:
            return "scale ";
        default:
            return "move ";
    }
}

bool is_move(DragKind kind) {
    return kind == DragKind::move_in_plane || kind == DragKind::move_along_axis ||
           kind == DragKind::move_over_surface;
}

/// The mode along or around this axis that does the same; the free one, if `present` is already that.
DragMode constrained(DragMode present, int axis) {
    DragMode along;
    DragMode free;
    switch (present.kind) {
        case DragKind::turn_around_axis:
        case DragKind::turn_around_view:
        case DragKind::aim:
            along = {DragKind::turn_around_axis, axis};
            free = {DragKind::turn_around_view};
            break;
        case DragKind::scale:
        case DragKind::scale_along_axis:
            along = {DragKind::scale_along_axis, axis};
            free = {DragKind::scale};
            break;
        default:
            along = {DragKind::move_along_axis, axis};
            free = {DragKind::move_in_plane};
    }
    return present == along ? free : along;
}

/// A place for a new light, and where it shines.
struct Place {
    glm::vec3 position;
    glm::vec3 direction{0.0F, -1.0F, 0.0F};
};

/// Over the surface in the middle of the picture, at most half-way to what is over it; otherwise, at the
/// pivot.
Place place_for_light(const tools::SceneRays& surfaces, const tools::Ray& middle, const glm::vec3& pivot,
                      float height) {
    const std::optional<tools::SurfaceHit> hit = surfaces.first_hit(middle);
    if (!hit) return {pivot};
    const glm::vec3 off_surface = hit->point + 1e-3F * height * hit->normal;
    const std::optional<tools::SurfaceHit> above = surfaces.first_hit({off_surface, hit->normal});
    const float free = above ? std::min(height, 0.5F * above->distance) : height;
    return {hit->point + free * hit->normal, -hit->normal};
}

/// How far a box reaches along a direction of unit length, metres; 0 if it is empty.
float width_along(const Box& box, const glm::vec3& direction) {
    if (box.lower.x > box.upper.x) return 0.0F;
    return glm::dot(glm::abs(direction), box.upper - box.lower);
}

}  // namespace

Interaction::Interaction(World& world, Entity camera) : world_(&world), viewer_(world, camera) {}

Viewport Interaction::viewport() const {
    return make_viewport(*world_, viewer_.entity(), size_, origin_);
}

std::optional<Command> Interaction::handle(const InputEvent& event, glm::vec2 size, glm::vec2 origin) {
    size_ = glm::max(size, glm::vec2(1.0F));
    origin_ = origin;
    const Viewport viewport = this->viewport();
    switch (event.kind) {
        case InputEvent::Kind::press:
            press(event, viewport);
            break;
        case InputEvent::Kind::release:
            release(event, viewport);
            break;
        case InputEvent::Kind::move:
            move(event.position, viewport);
            break;
        case InputEvent::Kind::scroll:
            scroll(event.scrolled);
            break;
        case InputEvent::Kind::key:
            return press_key(event, viewport);
        case InputEvent::Kind::key_release:
            viewer_.flying().release(event.code);
            break;
        case InputEvent::Kind::focus_lost:
            viewer_.flying().stop();
            end_gesture();
            break;
        case InputEvent::Kind::character:
        case InputEvent::Kind::focus_gained:
            break;
    }
    return std::nullopt;
}

void Interaction::step(float seconds, glm::vec2 size, glm::vec2 origin) {
    size_ = glm::max(size, glm::vec2(1.0F));
    origin_ = origin;
    if (selected && !is_present(*world_, *selected)) selected.reset();
    surfaces_.update(*world_);
    find_enclosed();
    viewer_.step(seconds);
}

void Interaction::find_enclosed() {
    if (surfaces_.building() || searched_at_ == world_->revision()) return;
    searched_at_ = world_->revision();
    enclosed_ = enclosed_lights(*world_, surfaces_);
}

// The pointer.

void Interaction::press(const InputEvent& event, const Viewport& viewport) {
    if (!std::holds_alternative<std::monostate>(gesture_)) return;
    history_.end_of_gesture();
    pointer_ = event.position;
    button_ = event.code;
    const bool left = event.code == GLFW_MOUSE_BUTTON_LEFT;
    const bool shift = (event.modifiers & GLFW_MOD_SHIFT) != 0;
    toggles_ = (event.modifiers & GLFW_MOD_CONTROL) != 0;
    if (event.code == GLFW_MOUSE_BUTTON_MIDDLE || (left && shift)) {
        gesture_ = Panning();
    } else if (event.code == GLFW_MOUSE_BUTTON_RIGHT) {
        gesture_ = Looking();
    } else if (left) {
        press_left(viewport);
    }
}

void Interaction::press_left(const Viewport& viewport) {
    const std::optional<Gizmo> shown = gizmo(viewport);
    if (shown && !toggles_) {
        if (const auto handle = handle_at(*shown, pointer_, handle_radius * unit)) {
            return grab(*selected, shown->handles[*handle].mode, viewport);
        }
    }
    if (const auto light = pick(light_markers(*world_), viewport, pointer_, pick_radius * unit)) {
        if (toggles_) return toggle(*light);
        std::vector<Entity> all = all_selected();
        const auto at = std::ranges::find(all, *light);
        if (at == all.end()) {
            selected = light;
        } else {
            std::rotate(all.begin(), at, at + 1);
            select(all);
        }
        return grab(*light, marker_mode(*light), viewport);
    }
    gesture_ = Orbiting{pointer_};
}

void Interaction::grab(Entity entity, DragMode mode, const Viewport& viewport) {
    gesture_ = Dragging{Drag(*world_, viewport, entity, mode, centre_of(entity), pointer_), pointer_};
}

/// Other buttons did nothing when they were pressed.
void Interaction::release(const InputEvent& event, const Viewport& viewport) {
    if (event.code != button_) return;
    const auto* orbiting = std::get_if<Orbiting>(&gesture_);
    if (orbiting != nullptr && !orbiting->moved) click(viewport);
    end_gesture();
}

void Interaction::end_gesture() {
    history_.commit(*world_);
    gesture_ = std::monostate();
}

void Interaction::click(const Viewport& viewport) {
    const std::optional<tools::SurfaceHit> hit = surfaces_.first_hit(ray_through(viewport, pointer_));
    if (!hit && surfaces_.building()) return;  // there may be something
    if (toggles_) {
        if (hit) toggle(hit->entity);
        return;
    }
    selected = hit ? std::optional(hit->entity) : std::nullopt;
}

bool Interaction::far_from(glm::vec2 pressed_at) const {
    return glm::distance(pointer_, pressed_at) > click_distance * unit;
}

void Interaction::move(glm::vec2 position, const Viewport& viewport) {
    const glm::vec2 motion = position - pointer_;
    pointer_ = position;
    if (auto* dragging = std::get_if<Dragging>(&gesture_)) {
        if (dragging->moved || far_from(dragging->pressed_at)) drag(*dragging, viewport);
    } else if (auto* orbiting = std::get_if<Orbiting>(&gesture_)) {
        if (!orbiting->moved && !far_from(orbiting->pressed_at)) return;
        viewer_.orbit_by(orbiting->moved ? motion : position - orbiting->pressed_at, viewport);
        orbiting->moved = true;
    } else if (std::holds_alternative<Panning>(gesture_)) {
        viewer_.pan_by(motion, viewport);
    } else if (std::holds_alternative<Looking>(gesture_)) {
        viewer_.look_by(motion, viewport);
    }
}

void Interaction::start(Dragging& dragging) {
    if (dragging.moved) return;
    const Entity entity = dragging.drag.entity();
    const bool together = is_move(dragging.drag.mode().kind);
    std::vector<Entity> moved{entity};
    dragging.from = position_of(*world_, entity);
    const std::vector<Entity> roots = selected_roots();
    // What is below another selected one already moves with that.
    if (together && std::ranges::count(roots, entity) > 0) {
        for (const Entity other : roots) {
            if (other == entity) continue;
            moved.push_back(other);
            dragging.others.emplace_back(other, position_of(*world_, other));
        }
    }
    history_.begin(*world_, std::string(verb_of(dragging.drag.mode().kind)) + title_of(*world_, moved),
                   moved);
    dragging.moved = true;
}

void Interaction::move_others(const Dragging& dragging) {
    const glm::vec3 motion = position_of(*world_, dragging.drag.entity()) - dragging.from;
    for (const auto& [entity, from] : dragging.others) move_to(*world_, entity, from + motion);
}

void Interaction::drag(Dragging& dragging, const Viewport& viewport) {
    start(dragging);
    dragging.drag.follow(*world_, viewport, pointer_, surfaces_, surface_gap * viewer_.scene_radius());
    move_others(dragging);
}

void Interaction::scroll(float notches) {
    if (viewer_.moving() || std::holds_alternative<Looking>(gesture_)) {
        viewer_.flying().adjust_speed(notches);
    } else if (!dragged()) {
        viewer_.zoom_by(notches);
    }
}

std::optional<Entity> Interaction::dragged() const {
    const auto* dragging = std::get_if<Dragging>(&gesture_);
    return dragging != nullptr ? std::optional(dragging->drag.entity()) : std::nullopt;
}

// The selection.

std::vector<Entity> Interaction::all_selected() const {
    std::vector<Entity> all;
    if (!selected) return all;
    all.push_back(*selected);
    if (others_.first != *selected) return all;
    std::ranges::copy_if(others_.entities, std::back_inserter(all),
                         [&](Entity entity) { return is_present(*world_, entity); });
    return all;
}

void Interaction::select(const std::vector<Entity>& entities) {
    selected = entities.empty() ? std::nullopt : std::optional(entities.front());
    others_ = {};
    if (entities.size() > 1) others_ = {entities.front(), {entities.begin() + 1, entities.end()}};
}

void Interaction::toggle(Entity entity) {
    std::vector<Entity> all = all_selected();
    if (std::erase(all, entity) == 0) all.insert(all.begin(), entity);
    select(all);
}

std::vector<Entity> Interaction::selected_roots() const {
    return roots_of(*world_, all_selected());
}

// What is shown.

glm::vec3 Interaction::centre_of(Entity entity) const {
    return has_place(*world_, entity) ? position_of(*world_, entity) : viewer_.orbit().pivot();
}

DragMode Interaction::marker_mode(Entity light) const {
    switch (usable_tool(*world_, light, tool)) {
        case Tool::surface:
            return {DragKind::move_over_surface};
        case Tool::turn:
            return {has_direction(*world_, light) ? DragKind::aim : DragKind::turn_around_view};
        case Tool::scale:
            return {DragKind::scale};
        case Tool::move:
            break;
    }
    return {DragKind::move_in_plane};
}

std::optional<Gizmo> Interaction::gizmo(const Viewport& viewport) const {
    if (!selected || !is_present(*world_, *selected)) return std::nullopt;
    return make_gizmo(*world_, viewport, *selected, usable_tool(*world_, *selected, tool),
                      centre_of(*selected), gizmo_size * unit);
}

Overlay Interaction::overlay(const Viewport& viewport, bool pointer_here) const {
    Overlay overlay;
    overlay.gizmo = gizmo(viewport);
    const auto* dragging = std::get_if<Dragging>(&gesture_);
    const bool hovering = std::holds_alternative<std::monostate>(gesture_) && pointer_here;
    if (overlay.gizmo && dragging != nullptr) {
        const auto& handles = overlay.gizmo->handles;
        const auto at = std::find_if(handles.begin(), handles.end(), [&](const Handle& handle) {
            return handle.mode == dragging->drag.mode();
        });
        if (at != handles.end()) overlay.active = static_cast<std::size_t>(at - handles.begin());
    } else if (overlay.gizmo && hovering) {
        overlay.active = handle_at(*overlay.gizmo, pointer_, handle_radius * unit);
    }
    const bool over_picture = hovering && !overlay.active;
    const std::optional<Entity> hovered =
        over_picture ? pick(light_markers(*world_), viewport, pointer_, pick_radius * unit) : std::nullopt;
    overlay.lights = light_labels(*world_, viewport, surfaces_, hovered, selected);
    for (const Entity other : all_selected()) {
        if (other == selected || !has_place(*world_, other)) continue;
        if (const auto at = project(viewport, position_of(*world_, other))) overlay.others.push_back(*at);
    }
    return overlay;
}

// Keys.

std::optional<Command> Interaction::press_key(const InputEvent& event, const Viewport& viewport) {
    if (flies(event)) {
        if (!dragged()) viewer_.flying().press(event.code);
        return std::nullopt;
    }
    const KeyBinding* binding = find_binding(event.code, event.modifiers);
    if (binding == nullptr || (event.repeated && !repeats(binding->action))) return std::nullopt;
    if (binding->action == Action::nudge) {
        nudge_selected(event.code, viewport);
        return std::nullopt;
    }
    if (carry_out(binding->action)) return std::nullopt;
    return Command{binding->action, binding->action == Action::preset ? event.code - GLFW_KEY_0 : 0};
}

bool Interaction::carry_out(Action action) {
    const bool axis = action == Action::along_x || action == Action::along_y || action == Action::along_z;
    if (dragged() && action < Action::cancel && !axis) return true;  // a drag is one edit
    switch (action) {
        case Action::undo:
            select_touched(history_.undo(*world_));
            return true;
        case Action::redo:
            select_touched(history_.redo(*world_));
            return true;
        case Action::copy:
            copy_selected();
            return true;
        case Action::remove:
            remove_selected();
            return true;
        case Action::add_point_light:
            add(PointLight{});
            return true;
        case Action::add_spot_light:
            add(SpotLight{});
            return true;
        case Action::add_directional_light:
            add(DirectionalLight{});
            return true;
        case Action::tool_move:
            tool = Tool::move;
            return true;
        case Action::tool_surface:
            tool = Tool::surface;
            return true;
        case Action::tool_turn:
            tool = Tool::turn;
            return true;
        case Action::tool_scale:
            tool = Tool::scale;
            return true;
        case Action::along_x:
        case Action::along_y:
        case Action::along_z:
            constrain(static_cast<int>(action) - static_cast<int>(Action::along_x));
            return true;
        case Action::frame_selected:
            frame_selected();
            return true;
        case Action::reset_view:
            viewer_.reset();
            return true;
        case Action::fly:
        case Action::nudge:
            return true;
        case Action::cancel:
            return cancel();
        default:
            return false;
    }
}

void Interaction::constrain(int axis) {
    auto* dragging = std::get_if<Dragging>(&gesture_);
    if (dragging == nullptr) return;
    start(*dragging);
    dragging->drag.set_mode(*world_, constrained(dragging->drag.mode(), axis));
    drag(*dragging, viewport());
}

/// A drag, else the selection.
bool Interaction::cancel() {
    if (dragged()) {
        history_.cancel(*world_);
        gesture_ = std::monostate();
        return true;
    }
    if (!selected) return false;
    selected.reset();
    return true;
}

void Interaction::nudge_selected(int key, const Viewport& viewport) {
    if (!selected || dragged() || !is_present(*world_, *selected)) return;
    const std::vector<Entity> roots = selected_roots();
    EntityStates before = states_of(*world_, roots);
    for (const Entity entity : roots) {
        nudge(*world_, entity, viewport, direction_of_key(key) * nudge_step * viewer_.scene_radius());
    }
    history_.record(*world_, "nudge " + title_of(*world_, roots), std::move(before));
}

void Interaction::select_touched(const std::vector<Entity>& touched) {
    if (touched.empty()) return;
    std::vector<Entity> present;
    std::ranges::copy_if(touched, std::back_inserter(present),
                         [&](Entity entity) { return is_present(*world_, entity); });
    select(roots_of(*world_, present));
}

void Interaction::add(const AnyLight& light) {
    const float radius = viewer_.scene_radius();
    const tools::Ray middle = ray_through(viewport(), origin_ + 0.5F * size_);
    Place place = place_for_light(surfaces_, middle, viewer_.orbit().pivot(), light_height * radius);
    const bool far_away =
        std::visit([]<class Light>(const Light&) { return !light_traits<Light>.has_position; }, light);
    if (far_away) place.direction = {-0.4F, -1.0F, -0.3F};  // like a sun
    selected = add_light(*world_, history_, light, place.position, place.direction, 0.5F * radius);
}

/// Beside the originals as the viewer sees them: to the right, unless only the left is still in the picture.
void Interaction::copy_selected() {
    if (!selected || !is_present(*world_, *selected)) return;
    const std::vector<Entity> roots = selected_roots();
    Box box;
    for (const Entity entity : roots) {
        const Box own = box_of(*world_, family_of(*world_, entity));
        if (own.lower.x > own.upper.x) continue;
        box.grow(own.lower);
        box.grow(own.upper);
    }
    const glm::vec3 right = viewer_.orbit().rotation * glm::vec3(1.0F, 0.0F, 0.0F);
    const float width = width_along(box, right);
    constexpr float with_gap = 1.1F;
    const float offset = width > 0.0F ? with_gap * width : copy_offset * viewer_.scene_radius();
    const auto is_seen = [&](const glm::vec3& centre) {
        const std::optional<glm::vec2> at = project(viewport(), centre);
        return at && viewport().contains(*at);
    };
    const glm::vec3 centre = centre_of(*selected);
    const bool left = !is_seen(centre + offset * right) && is_seen(centre - offset * right);
    select(duplicate(*world_, history_, roots, (left ? -offset : offset) * right));
}

void Interaction::remove_selected() {
    if (!selected || !is_present(*world_, *selected)) return;
    remove(*world_, history_, all_selected());
    selected.reset();
}

void Interaction::frame_selected() {
    const float aspect = size_.x / size_.y;
    const bool somewhere = selected && is_present(*world_, *selected) && has_place(*world_, *selected);
    if (!somewhere) return viewer_.frame_scene(aspect);
    const Box box = box_of(*world_, family_of(*world_, *selected));
    if (box.lower.x <= box.upper.x) {
        const glm::vec3 half = 0.5F * (box.upper - box.lower);
        return viewer_.frame({box.lower + half, glm::length(half)}, aspect);
    }
    viewer_.frame({position_of(*world_, *selected), light_radius * viewer_.scene_radius()}, aspect);
}

}  // namespace candela::sandbox
