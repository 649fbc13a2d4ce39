#pragma once

#include <array>
#include <cstdint>

namespace candela::budgets {

/// What a shader takes of a GPU, as its compiler says.
struct ShaderCost {
    std::uint32_t waves = 0;      ///< that a SIMD holds at a time
    std::uint32_t registers = 0;  ///< vector registers of a lane
    std::uint32_t spilled = 0;    ///< registers that are kept in memory for lack of room, vector and scalar
    std::uint32_t scratch = 0;    ///< bytes of memory of a lane: what is spilled, and arrays
    bool operator==(const ShaderCost&) const = default;
};

struct Figure {
    const char* name;
    std::uint32_t ShaderCost::*of;

    /// Of waves, few are bad; of all else, many.
    [[nodiscard]] bool is_worse(const ShaderCost& cost, const ShaderCost& than) const {
        return of == &ShaderCost::waves ? cost.*of < than.*of : cost.*of > than.*of;
    }
};
inline constexpr std::array figures{
    Figure{"waves", &ShaderCost::waves}, Figure{"registers", &ShaderCost::registers},
    Figure{"spilled", &ShaderCost::spilled}, Figure{"scratch", &ShaderCost::scratch}};

/// The worse of each figure.
[[nodiscard]] inline ShaderCost worst(ShaderCost a, const ShaderCost& b) {
    for (const Figure& figure : figures) {
        if (figure.is_worse(b, a)) a.*figure.of = b.*figure.of;
    }
    return a;
}

/// The GPUs that are asked, by the names that Mesa gives them: of RDNA 2, RDNA 3 and GCN 5.
inline constexpr std::array gpus{"navi21", "gfx1100", "vega10"};

/// On each of `gpus`.
using Costs = std::array<ShaderCost, gpus.size()>;

}  // namespace candela::budgets
