#pragma once

#include <memory>
#include <optional>

#include "sandbox/animation/clips.hpp"
#include "sandbox/animation/drag_recorder.hpp"
#include "sandbox/animation/playback.hpp"
#include "sandbox/command_line/options.hpp"
#include "sandbox/editing/interaction.hpp"
#include "sandbox/editing/materials.hpp"
#include "sandbox/editing/object_tree.hpp"
#include "sandbox/scene/scene.hpp"

namespace candela::sandbox {

/// An opened scene, and what the user does with it.
struct Document {
    Scene scene;
    Interaction interaction;
    ObjectTree objects;
    std::optional<Playback> playback;      ///< of a script
    ClipPlayback clips;                    ///< of the scene's file
    MaterialEdit material_edit;            ///< of a control that is held
    std::optional<DragRecorder> recorder;  ///< while the motion of an entity is recorded

    /// `camera` names the camera to start from, as in Options; `aspect`: width / height of the picture.
    Document(Scene opened, const std::optional<std::string>& camera, float aspect);
    Document(const Document&) = delete;
    Document& operator=(const Document&) = delete;

    [[nodiscard]] bool is_playing() const {
        return (playback && playback->playing()) || plays_clips(scene.world);
    }
    /// Shows the next frame of the script, and the scene's clips `seconds` later. The viewer follows the
    /// camera that it started from if that moves, even if the user has moved away. Returns whether the scene
    /// has jumped to another place of the script.
    bool animate(double seconds = 0.0);
    /// Pauses or resumes the script, or, if there is none, the clips.
    void toggle_playback();
    /// Goes on by a frame and pauses.
    void step_playback();

    /// A copy of the world for another thread; the same one while nothing changes.
    [[nodiscard]] std::shared_ptr<const World> copy_of_world();

 private:
    std::shared_ptr<const World> copy_;
};

}  // namespace candela::sandbox
