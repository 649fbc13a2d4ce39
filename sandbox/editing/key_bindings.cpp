#include "sandbox/editing/key_bindings.hpp"

#include <GLFW/glfw3.h>

#include <algorithm>
#include <array>

namespace candela::sandbox {

namespace {

constexpr int control = GLFW_MOD_CONTROL;
constexpr int shift = GLFW_MOD_SHIFT;

// clang-format off
constexpr std::array bindings{
    KeyBinding{GLFW_KEY_F1, 0, Action::panel, "F1", "show or hide the panel"},
    KeyBinding{GLFW_KEY_H, 0, Action::help, "H", "show or hide these keys"},
    KeyBinding{GLFW_KEY_F11, 0, Action::full_screen, "F11", "full screen, and back"},
    KeyBinding{GLFW_KEY_F12, 0, Action::screenshot, "F12", "save a screenshot"},
    KeyBinding{GLFW_KEY_O, control, Action::open_scene, "Ctrl+O", "open a scene"},
    KeyBinding{GLFW_KEY_S, control, Action::save_scene, "Ctrl+S", "save the scene as glTF"},
    KeyBinding{GLFW_KEY_S, control | shift, Action::save_configuration, "Ctrl+Shift+S", "save the configuration"},
    KeyBinding{GLFW_KEY_Q, control, Action::quit, "Ctrl+Q", "quit"},

    KeyBinding{GLFW_KEY_W, 0, Action::fly, "W A S D", "fly forwards, left, backwards, right; faster with Shift"},
    KeyBinding{GLFW_KEY_A, 0, Action::fly, "", ""},
    KeyBinding{GLFW_KEY_S, 0, Action::fly, "", ""},
    KeyBinding{GLFW_KEY_D, 0, Action::fly, "", ""},
    KeyBinding{GLFW_KEY_Q, 0, Action::fly, "Q E", "fly down, up"},
    KeyBinding{GLFW_KEY_E, 0, Action::fly, "", ""},
    KeyBinding{GLFW_KEY_F, 0, Action::frame_selected, "F", "look at the selection, or at the whole scene"},
    KeyBinding{GLFW_KEY_HOME, 0, Action::reset_view, "Home", "back to the scene's camera"},

    KeyBinding{GLFW_KEY_G, 0, Action::tool_move, "G", "move the selection"},
    KeyBinding{GLFW_KEY_V, 0, Action::tool_surface, "V", "move the selection over surfaces"},
    KeyBinding{GLFW_KEY_R, 0, Action::tool_turn, "R", "turn the selection, aim a light"},
    KeyBinding{GLFW_KEY_T, 0, Action::tool_scale, "T", "scale the selection"},
    KeyBinding{GLFW_KEY_X, 0, Action::along_x, "X Y Z", "while dragging: only along this axis; again: freely"},
    KeyBinding{GLFW_KEY_Y, 0, Action::along_y, "", ""},
    KeyBinding{GLFW_KEY_Z, 0, Action::along_z, "", ""},
    KeyBinding{GLFW_KEY_LEFT, 0, Action::nudge, "arrows, Page Up, Page Down", "move the selection a little"},
    KeyBinding{GLFW_KEY_RIGHT, 0, Action::nudge, "", ""},
    KeyBinding{GLFW_KEY_UP, 0, Action::nudge, "", ""},
    KeyBinding{GLFW_KEY_DOWN, 0, Action::nudge, "", ""},
    KeyBinding{GLFW_KEY_PAGE_UP, 0, Action::nudge, "", ""},
    KeyBinding{GLFW_KEY_PAGE_DOWN, 0, Action::nudge, "", ""},
    KeyBinding{GLFW_KEY_ESCAPE, 0, Action::cancel, "Esc", "cancel loading or a drag; deselect; close the help"},

    KeyBinding{GLFW_KEY_Z, control, Action::undo, "Ctrl+Z", "undo"},
    KeyBinding{GLFW_KEY_Z, control | shift, Action::redo, "Ctrl+Shift+Z, Ctrl+Y", "redo"},
    KeyBinding{GLFW_KEY_Y, control, Action::redo, "", ""},
    KeyBinding{GLFW_KEY_D, control, Action::copy, "Ctrl+D", "copy the selection"},
    KeyBinding{GLFW_KEY_DELETE, 0, Action::remove, "Delete", "delete the selection"},
    KeyBinding{GLFW_KEY_L, 0, Action::add_point_light, "L", "add a point light"},
    KeyBinding{GLFW_KEY_L, shift, Action::add_spot_light, "Shift+L", "add a spot light"},
    KeyBinding{GLFW_KEY_L, control, Action::add_directional_light, "Ctrl+L", "add a directional light"},

    KeyBinding{GLFW_KEY_1, 0, Action::preset, "1 to 9", "presets of the configuration"},
    KeyBinding{GLFW_KEY_2, 0, Action::preset, "", ""},
    KeyBinding{GLFW_KEY_3, 0, Action::preset, "", ""},
    KeyBinding{GLFW_KEY_4, 0, Action::preset, "", ""},
    KeyBinding{GLFW_KEY_5, 0, Action::preset, "", ""},
    KeyBinding{GLFW_KEY_6, 0, Action::preset, "", ""},
    KeyBinding{GLFW_KEY_7, 0, Action::preset, "", ""},
    KeyBinding{GLFW_KEY_8, 0, Action::preset, "", ""},
    KeyBinding{GLFW_KEY_9, 0, Action::preset, "", ""},
    KeyBinding{GLFW_KEY_P, 0, Action::next_path, "P", "next shading path"},
    KeyBinding{GLFW_KEY_P, shift, Action::previous_path, "Shift+P", "previous shading path"},
    KeyBinding{GLFW_KEY_B, 0, Action::compare, "B", "compare two configurations"},
    KeyBinding{GLFW_KEY_N, 0, Action::next_resource, "N", "see the next resource of the frame graph"},
    KeyBinding{GLFW_KEY_N, shift, Action::previous_resource, "Shift+N", "see the previous resource"},
    KeyBinding{GLFW_KEY_SPACE, 0, Action::play_pause, "Space", "play or pause the animation"},
    KeyBinding{GLFW_KEY_PERIOD, 0, Action::step_frame, "period", "next frame of the animation"},
    KeyBinding{GLFW_KEY_R, control, Action::record_drag, "Ctrl+R", "start or end recording a drag as an animation"}};

constexpr std::array mouse{
    MouseHelp{"left, dragged", "move a light or a handle of the selection; elsewhere, orbit"},
    MouseHelp{"left, clicked", "select a light or an object; nothing there: deselect"},
    MouseHelp{"Ctrl and left, clicked", "select it besides others, or no more"},
    MouseHelp{"middle, or Shift and left", "pan"},
    MouseHelp{"right", "look around"},
    MouseHelp{"wheel", "nearer or farther; while flying: faster or slower"}};
// clang-format on

}  // namespace

std::span<const KeyBinding> key_bindings() {
    return bindings;
}

const KeyBinding* find_binding(int key, int modifiers) {
    const int pressed = modifiers & (GLFW_MOD_CONTROL | GLFW_MOD_SHIFT | GLFW_MOD_ALT);
    const auto matches = [&](const KeyBinding& binding) {
        const int ignored = binding.action == Action::fly ? GLFW_MOD_SHIFT : 0;
        return binding.key == key && binding.modifiers == (pressed & ~ignored);
    };
    const auto* found = std::find_if(bindings.begin(), bindings.end(), matches);
    return found == bindings.end() ? nullptr : found;
}

bool repeats(Action action) {
    switch (action) {
        case Action::nudge:
        case Action::undo:
        case Action::redo:
        case Action::step_frame:
        case Action::next_path:
        case Action::previous_path:
        case Action::next_resource:
        case Action::previous_resource:
            return true;
        default:
            return false;
    }
}

bool works_while_typing(Action action) {
    switch (action) {
        case Action::open_scene:
        case Action::save_scene:
        case Action::save_configuration:
        case Action::screenshot:
        case Action::full_screen:
        case Action::panel:
        case Action::quit:
            return true;
        default:
            return false;
    }
}

std::span<const MouseHelp> mouse_help() {
    return mouse;
}

}  // namespace candela::sandbox
