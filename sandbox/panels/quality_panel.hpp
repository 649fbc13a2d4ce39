#pragma once

#include <candela/configuration.hpp>
#include <candela/report.hpp>

namespace candela::sandbox {

/// The settings of a configuration, and the noise at which refinement ends: see FrameRequest. `present` is
/// the quality of the last frame.
void draw_quality_panel(Configuration& configuration, double& noise_limit, const Quality& present);

}  // namespace candela::sandbox
