#pragma once

#include <cstdint>

namespace candela {

/// How many VPLs there are of each kind. Their indices run through the kinds in this order.
struct VplCounts {
    std::uint32_t traced = 0;       ///< on paths from the lights; then there are no others
    std::uint32_t surfels = 0;      ///< on surfaces that emit no light
    std::uint32_t emitters = 0;     ///< surfels on surfaces that emit light
    std::uint32_t sky_patches = 0;  ///< patches of the sky
    std::uint32_t directions = 0;   ///< of light that is the same everywhere: LitSurfels::balanced
    std::uint32_t accounts = 0;     ///< elements of Vpls::flux
    bool operator==(const VplCounts&) const = default;

    /// VPLs that have depth maps if visibility is found by maps: the first ones.
    [[nodiscard]] std::uint32_t mapped() const { return traced + surfels; }
    [[nodiscard]] std::uint32_t all_surfels() const { return surfels + emitters; }
    [[nodiscard]] std::uint32_t sources() const { return mapped() + emitters + sky_patches + directions; }
};

}  // namespace candela
