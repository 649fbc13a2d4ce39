#pragma once

#include <optional>

#include "sandbox/animation/animation.hpp"

namespace candela::sandbox {

/// The playback position of a script in a window. While playing, each frame of the window advances the script
/// by one frame.
///
/// While playing, the script overwrites what it animates: a light that the user drags is back in the next
/// frame. While paused, the user's changes stay until playback resumes, steps or seeks.
class Playback {
 public:
    /// Starts playing at frame 0. Keeps a reference to the animation.
    explicit Playback(const Animation& animation) : animation_(&animation) {}

    [[nodiscard]] int frame() const { return frame_; }
    [[nodiscard]] int frames() const { return animation_->script().frames; }
    [[nodiscard]] bool playing() const { return playing_; }

    /// Pauses or resumes. At the end of a script that does not loop, resumes from frame 0.
    void toggle();
    /// Advances by one frame and pauses; the last frame is followed by the first.
    void step();
    /// Goes to this frame, 0 to frames() - 1, and pauses.
    void seek(int frame);

    /// Call this before each frame of the window: sets the world to the current frame if it differs from the
    /// one shown last. Pauses at the end of a script that does not loop.
    void advance(World& world);

    /// Whether the frame that was shown last follows a seek or a step, and not the frame before it.
    [[nodiscard]] bool jumped() const { return jumped_; }

 private:
    [[nodiscard]] bool at_end() const { return frame_ + 1 == frames() && !animation_->script().loop; }

    const Animation* animation_;
    int frame_ = 0;
    bool playing_ = true;
    bool jumped_ = false;
    std::optional<int> shown_;  ///< nullopt: the next frame must be applied
};

}  // namespace candela::sandbox
