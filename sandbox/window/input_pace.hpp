#pragma once

#include <vector>

#include "sandbox/window/window.hpp"

namespace candela::sandbox {

/// Decides where frames must be drawn between the input events that Dear ImGui is told. It looks at keys and
/// buttons only when it draws: what was pressed and released between two frames has never happened. And only
/// a frame later does it say that a field has taken the keyboard.
class InputPace {
 public:
    /// Whether a frame must be drawn before this event is told. One frame may not be enough.
    [[nodiscard]] bool needs_frame_before(const InputEvent& event) const;
    /// The event is told now.
    void tell(const InputEvent& event);
    /// Something opens that takes the keyboard: the next key is for it.
    void move_focus();
    /// A frame was drawn.
    void draw();

 private:
    bool button_ = false;    // one was pressed or released since the last frame
    bool pressed_ = false;   // a key was pressed since then that is no modifier
    std::vector<int> keys_;  // pressed or released since then
    int to_focus_ = 0;       // frames until it is known who has the keyboard
};

}  // namespace candela::sandbox
