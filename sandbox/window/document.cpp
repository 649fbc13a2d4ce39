#include "sandbox/window/document.hpp"

#include <utility>

#include <candela/scene/hierarchy.hpp>

namespace candela::sandbox {

Document::Document(Scene opened, const std::optional<std::string>& camera, float aspect)
    : scene(std::move(opened)), interaction(scene.world, choose_camera(scene.world, camera, aspect)) {
    if (scene.animation) playback.emplace(*scene.animation);
}

bool Document::animate(double seconds) {
    const Entity camera = interaction.camera();
    const glm::mat4 before = world_matrix(scene.world, camera);
    if (playback) playback->advance(scene.world);
    clips.advance(scene.world, seconds);
    const bool jumped = playback && playback->jumped();
    const bool moved = world_matrix(scene.world, camera) != before;
    if (moved || (jumped && scene.animation->moves(scene.world, camera))) {
        interaction.look_from_camera(camera);
    }
    return jumped;
}

void Document::toggle_playback() {
    if (playback) return playback->toggle();
    toggle_clips(scene.world);
}

void Document::step_playback() {
    if (playback) return playback->step();
    clips.step(scene.world);
}

std::shared_ptr<const World> Document::copy_of_world() {
    if (!copy_ || copy_->revision() != scene.world.revision()) {
        copy_ = std::make_shared<const World>(scene.world);
    }
    return copy_;
}

}  // namespace candela::sandbox
