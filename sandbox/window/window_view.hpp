#pragma once

#include <vector>

#include <glm/vec2.hpp>

#include "sandbox/editing/key_bindings.hpp"
#include "sandbox/window/session_state.hpp"

namespace candela::sandbox {

/// Draws the picture, or the inspected resource, with what lies over it. `window`: the window's size in its
/// coordinates.
void draw_scene(SessionState& state, glm::vec2 window);

/// Draws the panel with its tabs, which change the state. Returns what the app must do.
[[nodiscard]] std::vector<Action> draw_panel(SessionState& state);

}  // namespace candela::sandbox
