#pragma once

#include "renderer/passes/vpl_memory.hpp"

namespace candela {

/// Shares each light's flux out among the paths that a schedule has, and works the plan's cells out where
/// `VplMemory::plan_areas` does not have them yet.
///
/// A light whose paths are all canonical keeps the plan's weights. Otherwise a path carries the flux of its
/// cell in the Voronoi diagram of starts on the light; bounces further on that of the diagram of those paths
/// that get there, and the sum at each bounce is the plan's: Laine et al., "Incremental Instant Radiosity for
/// Real-Time Indirect Illumination" (EGSR 2007), section 4. Paths that have hardly departed from their
/// points of the sequence carry as much more or less than that as they do there.
void weigh_by_cells(VplMemory& schedule, const LightTable& lights);

}  // namespace candela
