#pragma once

#include <glm/vec2.hpp>

namespace candela::sandbox {

/// A rectangle in window coordinates, whose origin is the upper left corner.
struct Rectangle {
    glm::vec2 corner{0.0F};  ///< the upper left one
    glm::vec2 size{0.0F};

    [[nodiscard]] bool contains(glm::vec2 point) const {
        return point.x >= corner.x && point.y >= corner.y && point.x < corner.x + size.x &&
               point.y < corner.y + size.y;
    }
};

/// Where the parts of the window are: the status line at the top, with a button at its right end, the panel
/// at the right, and the picture in the rest.
struct Layout {
    Rectangle status;
    Rectangle panel_button;  ///< hides and shows the panel
    Rectangle panel;         ///< width 0: not shown
    Rectangle scene;         ///< at least 1 × 1
};

/// How the window is divided.
struct LayoutSettings {
    bool panel = true;
    float panel_width = 340.0F;   ///< wanted; in units of the display's scale
    float status_height = 24.0F;  ///< window coordinates
};

/// The panel takes at most a third of the window's width, and is not shown where it would be too narrow to
/// read.
[[nodiscard]] Layout make_layout(glm::vec2 window, float scale, const LayoutSettings& settings);

}  // namespace candela::sandbox
