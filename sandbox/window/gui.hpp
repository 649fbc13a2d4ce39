#pragma once

#include <cstdint>

#include <imgui.h>

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
    static void end_frame();

    /// Factor on sizes, which are given for a display with 96 dots per inch; >= 1.
    [[nodiscard]] float scale() const { return scale_; }

    /// Whether ImGui currently uses the pointer, or the keyboard, for its panels.
    [[nodiscard]] static bool wants(InputEvent::Kind kind);

 private:
    void set_scale(float scale);

    const Window& window_;
    float scale_ = 0.0F;
};

/// Draws a texture behind the panels. `from` and `to`: the part of the rectangle that is drawn, in fractions
/// of its width.
void draw_picture(std::uint32_t texture, const Rectangle& at, float from = 0.0F, float to = 1.0F);

/// A name of a GL texture for Dear ImGui.
[[nodiscard]] ImTextureID image_of(std::uint32_t texture);

}  // namespace candela::sandbox
