#pragma once

#include <candela/report.hpp>
#include "sandbox/window/app_state.hpp"
#include "sandbox/window/reference_view.hpp"

namespace candela::sandbox {

/// What of the light is shown: which part of it, VPLs, a second configuration, the
/// path tracer's reference. `report`: of the last frame, null before it. `frame_ms`: time of a frame of the
/// configuration.
void draw_view_panel(AppState& state, const Report* report, const ReferenceView& reference, double frame_ms);

}  // namespace candela::sandbox
