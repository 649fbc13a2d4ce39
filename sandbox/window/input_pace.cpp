#include "sandbox/window/input_pace.hpp"

#include <GLFW/glfw3.h>

#include <algorithm>

namespace candela::sandbox {

namespace {

using Kind = InputEvent::Kind;

// Of Dear ImGui.
constexpr int frames_after_press = 2;    // in the first one the field is found, in the next one it says so
constexpr int frames_after_opening = 4;  // in the first one the field asks for the keyboard

bool is_modifier(int key) {
    return key >= GLFW_KEY_LEFT_SHIFT && key <= GLFW_KEY_RIGHT_SUPER;
}

/// Keys that write are told as characters, which are queued. Keys that are held repeat by themselves.
bool is_looked_at(const InputEvent& event) {
    constexpr int commands = GLFW_MOD_CONTROL | GLFW_MOD_ALT | GLFW_MOD_SUPER;
    constexpr int first_that_writes_nothing = GLFW_KEY_ESCAPE;
    return !event.repeated && (event.code >= first_that_writes_nothing || (event.modifiers & commands) != 0);
}

}  // namespace

bool InputPace::needs_frame_before(const InputEvent& event) const {
    switch (event.kind) {
        case Kind::press:
        case Kind::release:
        case Kind::move:
        case Kind::scroll:
            return button_;
        case Kind::character:
            return to_focus_ > 0 || pressed_;
        case Kind::key:
            return to_focus_ > 0 || (is_looked_at(event) && pressed_) ||
                   std::ranges::count(keys_, event.code) > 0;
        case Kind::key_release:
            return std::ranges::count(keys_, event.code) > 0 || (is_modifier(event.code) && pressed_);
        case Kind::focus_lost:
            return button_ || pressed_;
        case Kind::focus_gained:
            break;
    }
    return false;
}

void InputPace::tell(const InputEvent& event) {
    if (event.kind == Kind::press || event.kind == Kind::release) button_ = true;
    if (event.kind == Kind::press) to_focus_ = std::max(to_focus_, frames_after_press);
    const bool is_key = event.kind == Kind::key || event.kind == Kind::key_release;
    if (!is_key || !is_looked_at(event)) return;
    keys_.push_back(event.code);
    pressed_ |= event.kind == Kind::key && !is_modifier(event.code);
}

void InputPace::move_focus() {
    to_focus_ = frames_after_opening;
}

void InputPace::draw() {
    button_ = false;
    pressed_ = false;
    keys_.clear();
    to_focus_ = std::max(to_focus_ - 1, 0);
}

}  // namespace candela::sandbox
