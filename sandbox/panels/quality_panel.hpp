#pragma once

#include <candela/configuration.hpp>
#include <candela/report.hpp>

namespace candela::sandbox {

/// The settings of a configuration. `present` is the quality of the last frame.
void draw_quality_panel(Configuration& configuration, const Quality& present);

}  // namespace candela::sandbox
