#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include <imgui.h>

#include <glm/vec3.hpp>

#include <candela/configuration.hpp>
#include "sandbox/window/layout.hpp"

namespace candela::sandbox {

/// Where controls are, by their labels, for --ui-log. Only those that can be clicked now.
using ControlPlaces = std::map<std::string, Rectangle, std::less<>>;

/// The places of the controls that were drawn since the last call.
[[nodiscard]] ControlPlaces take_control_places();

// Controls of Dear ImGui with a tooltip, which says what the control does and in which unit. They return
// whether the user has changed the value, or pressed the button.

void text(std::string_view line);
bool button(const std::string& label, const char* tip);
bool checkbox(const char* label, bool& value, const char* tip);
/// One of several values that exclude each other; the chosen one is highlighted.
bool choice(const std::string& label, bool chosen, const char* tip);
bool drag(const char* label, std::uint32_t& value, float speed, std::uint32_t least, std::uint32_t most,
          const char* tip);
bool drag(const char* label, float& value, float speed, float least, float most, const char* tip);
bool drag(const char* label, glm::vec3& value, float speed, float least, float most, const char* tip);
bool slide(const char* label, float& value, float least, float most, const char* tip);
bool slide(const char* label, int& value, int least, int most, const char* tip);
bool colour(const char* label, glm::vec3& value, const char* tip);
/// A part of the panel that can be folded.
bool header(const char* label, bool open);
/// A tab of a tab bar, whose tooltip stands beside the window: below the tab it would cover what the tab
/// shows. Returns whether it is open; ImGui::EndTabItem must follow then.
[[nodiscard]] bool begin_tab(const char* label, const char* tip);

/// Puts a button with this label beside the last control, unless the panel ends there.
void same_line_if_it_fits(const std::string& label);
/// A button for each choice; `tip` is shown for those without a help of their own. Returns the index of the
/// chosen one.
[[nodiscard]] std::size_t choose(std::span<const Choice> choices, std::size_t chosen, const char* tip);

/// Records the place of the control that was drawn last and shows its tooltip; for controls that are drawn
/// without the functions above.
void note_control(std::string_view label, const char* tip);

}  // namespace candela::sandbox
