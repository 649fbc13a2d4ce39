#pragma once

#include <GLFW/glfw3.h>

#include <array>
#include <cstdint>

#include <imgui.h>
#include <glm/vec2.hpp>

#include "sandbox/window/input_pace.hpp"
#include "sandbox/window/layout.hpp"
#include "sandbox/window/window.hpp"

namespace candela::sandbox {

/// Dear ImGui in a window. Its context is current during the lifetime of this object; the process uses no
/// other one.
class Gui {
 public:
    explicit Gui(const Window& window);
    ~Gui();
    Gui(const Gui&) = delete;
    Gui& operator=(const Gui&) = delete;

    /// What is drawn with Dear ImGui between these two calls goes into the window's framebuffer. If the
    /// display's scale has changed, fonts and sizes follow it.
    void begin_frame();
    void end_frame();

    /// Whether a frame must be drawn before this event is told: see InputPace.
    [[nodiscard]] bool needs_frame_before(const InputEvent& event) const {
        return pace_.needs_frame_before(event);
    }
    /// Tells Dear ImGui of an event. It reacts in the next frame.
    void tell(const InputEvent& event);
    /// Something opens in the next frame that takes the keyboard: the next key is for it.
    void move_focus() { pace_.move_focus(); }

    /// Factor on sizes, which are given for a display with 96 dots per inch; >= 1.
    [[nodiscard]] float scale() const { return scale_; }

    /// Whether ImGui currently uses the pointer, or the keyboard, for its panels.
    [[nodiscard]] static bool wants(InputEvent::Kind kind);

 private:
    void set_scale(float scale);
    void place_pointer() const;

    const Window& window_;
    InputPace pace_;
    glm::vec2 pointer_{0.0F};                              // at the last event that was told
    std::array<bool, GLFW_MOUSE_BUTTON_LAST + 1> down_{};  // buttons, after it
    float scale_ = 0.0F;
};

/// Draws a texture behind the panels. `from` and `to`: the part of the rectangle that is drawn, in fractions
/// of its width.
void draw_picture(std::uint32_t texture, const Rectangle& at, float from = 0.0F, float to = 1.0F);

/// A name of a GL texture for Dear ImGui.
[[nodiscard]] ImTextureID image_of(std::uint32_t texture);

}  // namespace candela::sandbox
