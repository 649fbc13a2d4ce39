#pragma once

#include <cmath>

namespace candela {

/// Whether a rotation or a normal of this length counts as normalised. Rounding its members to floats changes
/// the length by up to 1e-7, and normalising it in single precision by a little more. What counts as
/// normalised is imported as it is: to normalise it once more could change the last bits.
[[nodiscard]] inline bool is_unit_length(double length) {
    constexpr double tolerance = 1e-6;
    return std::abs(length - 1.0) <= tolerance;
}

}  // namespace candela
