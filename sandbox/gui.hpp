#pragma once

#include <string>

#include "sandbox/light_picking.hpp"
#include "sandbox/window.hpp"

namespace candela::sandbox {

/// Dear ImGui in a window. Its context is current while this lives, and nothing else in the process uses it.
class Gui {
 public:
    explicit Gui(const Window& window);
    ~Gui();
    Gui(const Gui&) = delete;
    Gui& operator=(const Gui&) = delete;

    /// Between the two, what is drawn with Dear ImGui goes into the window's framebuffer.
    void begin_frame();
    void end_frame();

    /// Whether the pointer, or the keyboard, belongs to a panel at the moment.
    [[nodiscard]] bool wants(InputEvent::Kind kind) const;
};

/// Fills the window with words, for the time until there is a picture.
void show_words(Gui& gui, Window& window, const std::string& words);

/// Draws a ring and a name where each light is seen, behind the panels.
void draw_markers(const std::vector<LightMarker>& markers, const Viewport& viewport,
                  std::optional<Entity> selected);

}  // namespace candela::sandbox
