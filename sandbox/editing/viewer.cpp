#include "sandbox/editing/viewer.hpp"

#include <algorithm>
#include <cmath>

#include <glm/gtc/constants.hpp>

#include <candela/scene/components.hpp>
#include <candela/scene/hierarchy.hpp>

namespace candela::sandbox {

namespace {

constexpr float least_distance = 0.05F;  // from the eye to the pivot, relative to the scene's radius
constexpr float least_radius = 0.02F;    // of what is framed, relative to the scene's radius
constexpr float zoom_per_notch = 0.9F;

Bounds bounds_to_explore(const World& world) {
    Bounds scene = bounds(world);
    if (!(scene.radius > 0.0F)) scene.radius = 1.0F;
    return scene;
}

float angle_per_unit(const Viewport& viewport) {
    return glm::pi<float>() / viewport.size.y;
}

}  // namespace

Viewer::Viewer(World& world, Entity camera)
    : world_(&world), entity_(world.create()), scene_(bounds_to_explore(world)) {
    look_from_camera(camera);
}

void Viewer::look_from_camera(Entity camera) {
    camera_ = camera;
    orbit_ = look_from(world_matrix(*world_, camera), scene_.centre, least_distance * scene_.radius);
    world_->set(entity_, Camera(world_->get<Camera>(camera)));
    place();
}

void Viewer::reset() {
    if (world_->alive(camera_) && world_->has<Camera>(camera_)) look_from_camera(camera_);
}

void Viewer::place() {
    world_->set(entity_, Transform{.translation = orbit_.eye, .rotation = orbit_.rotation});
}

void Viewer::orbit_by(glm::vec2 motion, const Viewport& viewport) {
    orbit_ = orbited(orbit_, glm::vec2(-motion.x, motion.y) * angle_per_unit(viewport));
    place();
}

void Viewer::pan_by(glm::vec2 motion, const Viewport& viewport) {
    const glm::vec2 metres = motion * metres_per_unit(viewport, orbit_.pivot());
    orbit_ = moved(orbit_, {-metres.x, metres.y, 0.0F});
    place();
}

void Viewer::look_by(glm::vec2 motion, const Viewport& viewport) {
    orbit_ = looked_around(orbit_, -motion * angle_per_unit(viewport));
    place();
}

void Viewer::zoom_by(float notches) {
    const float wanted = std::pow(zoom_per_notch, notches);
    const float factor = std::max(wanted, std::min(1.0F, least_distance * scene_.radius / orbit_.distance));
    orbit_ = zoomed(orbit_, factor);
    world_->edit<Camera>(entity_, [&](Camera& camera) { camera.half_height *= factor; });
    place();
}

void Viewer::frame(Bounds sphere, float aspect) {
    sphere.radius = std::max(sphere.radius, least_radius * scene_.radius);
    world_->edit<Camera>(entity_, [&](Camera& camera) { orbit_ = framed(orbit_, sphere, aspect, camera); });
    place();
}

void Viewer::frame_scene(float aspect) {
    scene_ = bounds_to_explore(*world_);
    frame(scene_, aspect);
}

void Viewer::step(float seconds) {
    constexpr float longest = 0.1F;
    if (!moving()) return;
    orbit_ = moved(orbit_, flying_.motion(std::min(seconds, longest), scene_.radius));
    place();
}

}  // namespace candela::sandbox
