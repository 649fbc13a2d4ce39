#pragma once

#include <vector>

#include <candela/report.hpp>
#include "sandbox/editing/key_bindings.hpp"
#include "sandbox/window/app_state.hpp"
#include "sandbox/window/document.hpp"

namespace candela::sandbox {

/// Files, cameras, lights, objects, the sky and the animation of the scene. `report` may be null. Returns
/// what the app must do.
[[nodiscard]] std::vector<Action> draw_scene_panel(Document& document, const AppState& state,
                                                   const Report* report);

}  // namespace candela::sandbox
