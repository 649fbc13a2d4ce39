#include "sandbox/window/obsolete.hpp"

#include <cmath>

#include <glm/common.hpp>

namespace candela::sandbox {

namespace {

/// Whether both show the same scene in the same way, perhaps moved, or from elsewhere.
bool differ_by_motion_only(const FrameRequest& a, const FrameRequest& b) {
    FrameRequest moved = b;
    moved.world = a.world;
    moved.input = a.input;
    moved.cut = a.cut;
    return moved == a;
}

double pixels_of(glm::uvec2 size) {
    return static_cast<double>(size.x) * static_cast<double>(size.y);
}

/// The same shape with at most `pixels`, about.
glm::uvec2 limited(glm::uvec2 size, double pixels) {
    const double scale = std::sqrt(pixels / pixels_of(size));
    if (scale >= 1.0) return size;
    return glm::max(glm::uvec2(glm::round(glm::dvec2(size) * scale)), 1U);
}

}  // namespace

bool is_obsolete(const FrameInWork& frame, const FrameRequest& running, const FrameRequest& newer) {
    constexpr std::chrono::milliseconds soon_done(250);
    constexpr int most_in_a_row = 3;
    if (frame.refines) return true;
    if (frame.given_up >= most_in_a_row) return false;
    // It is of full quality, and the newer one of reduced quality.
    if (running.cut && !newer.cut) return true;
    return !differ_by_motion_only(running, newer) && frame.age > soon_done;
}

glm::uvec2 first_size(glm::uvec2 asked, const std::optional<FinishedFrame>& last) {
    constexpr double soon = 0.1;                    // seconds
    constexpr double always_quick = 640.0 * 360.0;  // pixels
    constexpr double most_if_slow = 1920.0 * 1080.0;
    constexpr double about_as_many = 1.5;
    if (!last) return limited(asked, always_quick);
    const double expected = last->seconds * pixels_of(asked) / pixels_of(last->rendered);
    if (expected <= soon) return asked;
    // The renderer reduces the quality of what moves by itself, by the time of the picture before.
    const bool known = pixels_of(asked) <= about_as_many * pixels_of(last->asked);
    return limited(asked, known ? most_if_slow : always_quick);
}

}  // namespace candela::sandbox
