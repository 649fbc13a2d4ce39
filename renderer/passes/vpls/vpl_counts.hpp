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
    std::uint32_t groups = 0;       ///< of `surfels`, which are summed in their place; 0: there are none
    std::uint32_t accounts = 0;     ///< elements of Vpls::flux
    bool operator==(const VplCounts&) const = default;

    /// VPLs that have depth maps if visibility is found by maps: the first ones.
    [[nodiscard]] std::uint32_t mapped() const { return traced + surfels; }
    [[nodiscard]] std::uint32_t all_surfels() const { return surfels + emitters; }
    /// What pixels sum instead of them: groups of surfels, if there are any.
    [[nodiscard]] std::uint32_t mapped_sources() const { return groups > 0 ? groups : mapped(); }
    /// What pixels sum in all. Its indices run through groups, emitters, sky patches and directions.
    [[nodiscard]] std::uint32_t sources() const {
        return mapped_sources() + emitters + sky_patches + directions;
    }
    /// Records of surfels and of their groups.
    [[nodiscard]] std::uint32_t lit_surfels() const { return surfels + groups; }
};

}  // namespace candela
