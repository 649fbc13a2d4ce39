#include "sandbox/interaction.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <candela/scene/components.hpp>
#include <candela/scene/hierarchy.hpp>

namespace candela::sandbox {

namespace {

constexpr float least_distance = 0.05F;  // from the eye to the pivot, relative to the scene's radius
constexpr float nudge_step = 0.02F;      // relative to the scene's radius
constexpr float zoom_per_notch = 0.9F;

/// The direction of a key in view space: +x right, +y up, +z towards the viewer.
glm::vec3 direction_of(int key) {
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

Bounds bounds_to_explore(const World& world) {
    Bounds scene = bounds(world);
    if (!(scene.radius > 0.0F)) scene.radius = 1.0F;
    return scene;
}

}  // namespace

Interaction::Interaction(World& world, Entity camera)
    : world_(&world), viewer_(world.create()), scene_(bounds_to_explore(world)) {
    look_from_camera(camera);
}

void Interaction::look_from_camera(Entity camera) {
    camera_ = camera;
    orbit_ = look_from(world_matrix(*world_, camera), scene_.centre, least_distance * scene_.radius);
    world_->set(viewer_, Camera(world_->get<Camera>(camera)));
    place_viewer();
}

void Interaction::place_viewer() {
    world_->set(viewer_, Transform{.translation = orbit_.eye, .rotation = orbit_.rotation});
}

void Interaction::handle(const InputEvent& event, glm::vec2 size) {
    const Viewport viewport = make_viewport(*world_, viewer_, size);
    switch (event.kind) {
        case InputEvent::Kind::press:
            press(event, viewport);
            break;
        case InputEvent::Kind::release:
            action_ = std::monostate();
            break;
        case InputEvent::Kind::move:
            move(event.position, viewport);
            break;
        case InputEvent::Kind::scroll:
            scroll(event.scrolled);
            break;
        case InputEvent::Kind::key:
            press_key(event.code, viewport);
            break;
    }
}

void Interaction::press(const InputEvent& event, const Viewport& viewport) {
    pointer_ = event.position;
    const bool left = event.code == GLFW_MOUSE_BUTTON_LEFT;
    const bool shift = (event.modifiers & GLFW_MOD_SHIFT) != 0;
    if (event.code == GLFW_MOUSE_BUTTON_MIDDLE || (left && shift)) {
        action_ = Panning();
        return;
    }
    if (!left) return;
    if (const auto light = pick(light_markers(*world_), viewport, event.position, pick_radius)) {
        selected = light;
        action_ = LightDrag(*world_, viewport, *light, event.position);
        return;
    }
    action_ = Orbiting();
}

void Interaction::move(glm::vec2 position, const Viewport& viewport) {
    const glm::vec2 moved = position - pointer_;
    pointer_ = position;
    if (const auto* light = std::get_if<LightDrag>(&action_)) return light->drag(*world_, viewport, position);
    // The grabbed point follows the pointer. A drag over the window's height turns by 180 degrees.
    if (std::holds_alternative<Orbiting>(action_)) {
        const float angle_per_unit = glm::pi<float>() / viewport.size.y;
        orbit_ = orbited(orbit_, glm::vec2(-moved.x, moved.y) * angle_per_unit);
    } else if (std::holds_alternative<Panning>(action_)) {
        orbit_ = panned(orbit_, glm::vec2(-moved.x, moved.y) * metres_per_unit(viewport));
    } else {
        return;
    }
    place_viewer();
}

float Interaction::metres_per_unit(const Viewport& viewport) const {
    const auto& camera = world_->get<Camera>(viewer_);
    const bool perspective = camera.projection == Camera::Projection::perspective;
    const float half_height =
        perspective ? orbit_.distance * std::tan(camera.vertical_fov * 0.5F) : camera.half_height;
    return 2.0F * half_height / viewport.size.y;
}

void Interaction::scroll(float notches) {
    const float wanted = std::pow(zoom_per_notch, notches);
    const float factor = std::max(wanted, std::min(1.0F, least_distance * scene_.radius / orbit_.distance));
    orbit_ = zoomed(orbit_, factor);
    world_->edit<Camera>(viewer_, [&](Camera& camera) { camera.half_height *= factor; });
    place_viewer();
}

void Interaction::press_key(int key, const Viewport& viewport) {
    const glm::vec3 direction = direction_of(key);
    if (selected && direction != glm::vec3(0.0F))
        nudge(*world_, *selected, viewport, direction * nudge_step * scene_.radius);
}

}  // namespace candela::sandbox
