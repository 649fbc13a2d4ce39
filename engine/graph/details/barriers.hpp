#pragma once

#include <vector>

#include "engine/graph/details/plan.hpp"

namespace candela::detail {

/// The barrier bit that orders an access after incoherent writes (OpenGL 4.5, section 7.13.2).
[[nodiscard]] Barrier barrier_for(ResourceKind kind, Usage usage);

/// The barriers to issue before each position, for a frame that is repeated in full.
///
/// Between an incoherent write and each later access of the same object there must be a barrier with the bit
/// of the later access; likewise between a read and each later incoherent write. One barrier serves all such
/// pairs that it lies between. `plan` must have its order and objects.
[[nodiscard]] std::vector<Barrier> plan_barriers(const Declaration& declared, const Plan& plan);

}  // namespace candela::detail
