#pragma once

#include <string>

#include "sandbox/light_picking.hpp"
#include "sandbox/window.hpp"

namespace candela::sandbox {

/// Dear ImGui in a window. Its context is current during the lifetime of this object; the process uses no
/// other one.
class Gui {
 public:
    explicit Gui(const Window& window);
    ~Gui();
    Gui(const Gui&) = delete;
    Gui& operator=(const Gui&) = delete;

    /// What is drawn with Dear ImGui between these two calls goes into the window's framebuffer.
    void begin_frame();
    void end_frame();

    /// Whether ImGui currently uses the pointer, or the keyboard, for its panels.
    [[nodiscard]] bool wants(InputEvent::Kind kind) const;
};

/// Shows a text on black in the whole window, until there is a picture.
void show_words(Gui& gui, Window& window, const std::string& words);

/// Draws a ring and a name at the position of each light, behind the panels.
void draw_markers(const std::vector<LightMarker>& markers, const Viewport& viewport,
                  std::optional<Entity> selected);

}  // namespace candela::sandbox
