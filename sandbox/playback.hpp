#pragma once

#include <optional>

#include "sandbox/animation.hpp"

namespace candela::sandbox {

/// How far a window is in a script: a frame of the script for each of the window's, until it is paused.
///
/// While it plays, what the script drives is the script's: a light that people drag is back in the next
/// frame. While it is paused they have it, until it plays on, steps or seeks.
class Playback {
 public:
    /// Plays from frame 0 on. Refers to the animation.
    explicit Playback(const Animation& animation) : animation_(&animation) {}

    [[nodiscard]] int frame() const { return frame_; }
    [[nodiscard]] int frames() const { return animation_->script().frames; }
    [[nodiscard]] bool playing() const { return playing_; }

    /// Pauses or plays on, after the end of a script that is no loop from the start.
    void toggle();
    /// Pauses at the next frame; after the last comes the first.
    void step();
    /// Pauses at this frame, 0 to frames() - 1.
    void seek(int frame);

    /// To be called before each of the window's frames: puts the world to the frame that is due, if that is
    /// not the one that was shown last. At the end of a script that is no loop it pauses.
    void advance(World& world);

 private:
    [[nodiscard]] bool at_end() const { return frame_ + 1 == frames() && !animation_->script().loop; }

    const Animation* animation_;
    int frame_ = 0;
    bool playing_ = true;
    std::optional<int> shown_;  ///< none: the next frame is put, whichever was shown
};

}  // namespace candela::sandbox
