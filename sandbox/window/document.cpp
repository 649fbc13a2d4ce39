#include "sandbox/window/document.hpp"

#include <utility>

#include <candela/scene/hierarchy.hpp>

namespace candela::sandbox {

Document::Document(Scene opened, const std::optional<std::string>& camera, float aspect)
    : scene(std::move(opened)), interaction(scene.world, choose_camera(scene.world, camera, aspect)) {
    if (scene.animation) playback.emplace(*scene.animation);
}

bool Document::animate() {
    if (!playback) return false;
    const Entity camera = interaction.camera();
    const glm::mat4 before = world_matrix(scene.world, camera);
    playback->advance(scene.world);
    const bool jumped = playback->jumped();
    const bool moved = world_matrix(scene.world, camera) != before;
    if (moved || (jumped && scene.animation->moves(scene.world, camera))) {
        interaction.look_from_camera(camera);
    }
    return jumped;
}

std::shared_ptr<const World> Document::copy_of_world() {
    if (!copy_ || copy_->revision() != scene.world.revision()) {
        copy_ = std::make_shared<const World>(scene.world);
    }
    return copy_;
}

}  // namespace candela::sandbox
