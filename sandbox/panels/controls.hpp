#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include <imgui.h>

#include <glm/vec3.hpp>

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
bool drag(const char* label, std::uint32_t& value, float speed, const char* tip);
bool drag(const char* label, float& value, float speed, float least, float most, const char* tip);
bool drag(const char* label, glm::vec3& value, float speed, float least, float most, const char* tip);
bool slide(const char* label, float& value, float least, float most, const char* tip);
bool slide(const char* label, int& value, int least, int most, const char* tip);
bool colour(const char* label, glm::vec3& value, const char* tip);
/// A part of the panel that can be folded.
bool header(const char* label, bool open);

/// A list of values with names.
template <class Enum>
bool combo(const char* label, Enum& value, std::span<const Enum> choices, const char* tip);

/// Records the place of the control that was drawn last and shows its tooltip; for controls that are drawn
/// without the functions above.
void note_control(std::string_view label, const char* tip);

template <class Enum>
bool combo(const char* label, Enum& value, std::span<const Enum> choices, const char* tip) {
    const bool open = ImGui::BeginCombo(label, std::string(to_string(value)).c_str());
    note_control(label, open ? nullptr : tip);
    if (!open) return false;
    bool changed = false;
    for (const Enum candidate : choices) {
        const std::string name(to_string(candidate));
        if (ImGui::Selectable(name.c_str(), candidate == value)) {
            value = candidate;
            changed = true;
        }
        note_control(name, nullptr);
    }
    ImGui::EndCombo();
    return changed;
}

}  // namespace candela::sandbox
