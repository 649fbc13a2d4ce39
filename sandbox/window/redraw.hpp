#pragma once

#include <chrono>

namespace candela::sandbox {

/// When a window is to be drawn. Without a GPU, drawing it takes time from the picture: so while nothing
/// happens it is not drawn, and while only the pointer moves, no more often than every `between_moves`, or
/// every `while_rendering` if a picture is on its way, with which the window is drawn anyway.
class Redraw {
 public:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::milliseconds between_moves{50};
    static constexpr std::chrono::milliseconds while_rendering{100};

    /// Something has changed. Panels need a few frames to settle.
    void changed() { frames_ = settling; }
    /// Only the picture has changed.
    void changed_once() {
        if (frames_ < 1) frames_ = 1;
    }
    void pointer_moved() { pointer_moved_ = true; }
    /// It is being drawn now.
    void draw(Clock::time_point now) {
        if (frames_ > 0) --frames_;
        pointer_moved_ = false;
        last_ = now;
    }

    [[nodiscard]] bool has_changes() const { return frames_ > 0; }
    [[nodiscard]] bool has_moves() const { return pointer_moved_; }
    /// Whether to draw now. `rendering`: a picture is on its way.
    [[nodiscard]] bool is_due(Clock::time_point now, bool rendering = false) const {
        return frames_ > 0 ||
               (pointer_moved_ && now - last_ >= (rendering ? while_rendering : between_moves));
    }

 private:
    static constexpr int settling = 3;

    int frames_ = settling;
    bool pointer_moved_ = false;
    Clock::time_point last_;
};

}  // namespace candela::sandbox
