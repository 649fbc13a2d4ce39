#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace candela::sandbox {

/// What a key does.
enum class Action : std::uint8_t {
    // By Interaction.
    undo,
    redo,
    copy,
    remove,
    add_point_light,
    add_spot_light,
    add_directional_light,
    tool_move,
    tool_surface,
    tool_turn,
    tool_scale,
    along_x,
    along_y,
    along_z,
    frame_selected,
    reset_view,
    fly,
    nudge,
    // By Interaction while there is something to cancel or to deselect, else by the app.
    cancel,
    // By the app.
    open_scene,
    save_scene,
    save_configuration,
    record_drag,
    screenshot,
    full_screen,
    panel,
    help,
    preset,
    next_path,
    previous_path,
    compare,
    next_resource,
    previous_resource,
    play_pause,
    step_frame,
    quit
};

/// A key with what it does. Neighbouring rows that belong together share the texts of the first.
struct KeyBinding {
    int key = 0;        ///< GLFW_KEY_...
    int modifiers = 0;  ///< GLFW_MOD_CONTROL, _SHIFT and _ALT, exactly these
    Action action = Action::cancel;
    std::string_view keys;  ///< for the user: "Ctrl+Z"
    std::string_view help;  ///< for the user
};

/// All keys, grouped by purpose, in the order of a help text.
[[nodiscard]] std::span<const KeyBinding> key_bindings();

/// The binding of a key; nullptr if it does nothing. Flying ignores shift, which makes it faster.
[[nodiscard]] const KeyBinding* find_binding(int key, int modifiers);

/// Whether holding the key repeats the action.
[[nodiscard]] bool repeats(Action action);

/// Whether the key does this also while a text field has the keyboard. Fields use many keys themselves.
[[nodiscard]] bool works_while_typing(Action action);

/// What the mouse does, for the same help text.
struct MouseHelp {
    std::string_view buttons;
    std::string_view help;
};
[[nodiscard]] std::span<const MouseHelp> mouse_help();

}  // namespace candela::sandbox
