#pragma once

#include <vector>

#include "engine/graph/compile.hpp"

namespace candela::detail {

/// What orders an access after incoherent writes (OpenGL 4.5, section 7.13.2).
[[nodiscard]] Barrier barrier_for(ResourceKind kind, Usage usage);

/// Barriers by position, for frames that repeat.
///
/// An access needs its bit between it and every earlier incoherent write of the same object, and an
/// incoherent write needs its bit between it and every earlier read. One barrier serves all that lie across
/// it. `plan` must have order and objects.
[[nodiscard]] std::vector<Barrier> plan_barriers(const Declaration& declared, const Plan& plan);

}  // namespace candela::detail
