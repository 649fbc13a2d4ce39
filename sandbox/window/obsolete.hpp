#pragma once

#include <chrono>
#include <optional>

#include <glm/vec2.hpp>

#include "sandbox/window/frame_request.hpp"

namespace candela::sandbox {

/// A frame that is being rendered.
struct FrameInWork {
    bool refines = false;                  ///< there is a picture of its request, which it makes better
    std::chrono::duration<double> age{0};  ///< since it was begun
    int given_up = 0;                      ///< how many frames in a row were given up before it, unfinished
};

/// Whether to give up a frame of the request `running`, because `newer` waits. A frame that only refines is
/// given up at once. One that shows the first picture of a request is finished if the newer one shows what
/// moves on from there: who drags without a pause sees a picture of each. If the newer one shows something
/// else, such as another size, the frame is given up unless it is soon done, or too many were given up
/// before.
[[nodiscard]] bool is_obsolete(const FrameInWork& frame, const FrameRequest& running,
                               const FrameRequest& newer);

/// A frame that was finished.
struct FinishedFrame {
    glm::uvec2 asked{1};     ///< pixels, of its request
    glm::uvec2 rendered{1};  ///< pixels; less while it had to be quick
    double seconds = 0.0;
};

/// The size in pixels in which the first picture of a request for `asked` pixels is rendered. It is smaller
/// where a picture of that size would take long, or where that is not known yet: then the window has a
/// picture soon, and the whole one follows.
[[nodiscard]] glm::uvec2 first_size(glm::uvec2 asked, const std::optional<FinishedFrame>& last);

}  // namespace candela::sandbox
