#pragma once

#include <candela/graph/describe.hpp>
#include "sandbox/editing/interaction.hpp"
#include "sandbox/panels/graph_panel.hpp"
#include "sandbox/window/app_state.hpp"

namespace candela::sandbox {

/// Carries out a command that changes only what is shown, and how: panel and help, presets and paths, the
/// comparison, and which resource of `graph` is selected. Returns whether it is such a command; others change
/// nothing.
bool change_view(const Command& command, const GraphDescription& graph, AppState& state,
                 GraphSelection& selection);

}  // namespace candela::sandbox
