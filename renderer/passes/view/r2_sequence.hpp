#pragma once

#include <cstdint>
#include <glm/common.hpp>
#include <glm/vec2.hpp>

namespace candela {

/// Point `index` of the R2 sequence that starts at `start`, in [0, 1)². The steps are the powers 1/p and
/// 1/p², where p is the real root of x³ = x + 1 (Roberts, "The Unreasonable Effectiveness of Quasirandom
/// Sequences", 2018).
[[nodiscard]] inline glm::dvec2 r2_point(std::uint32_t index, glm::dvec2 start) {
    constexpr glm::dvec2 step(0.7548776662466927, 0.5698402909980532);
    return glm::fract(start + step * static_cast<double>(index));
}

}  // namespace candela
