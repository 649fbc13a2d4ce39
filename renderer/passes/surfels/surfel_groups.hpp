#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "renderer/gpu/gpu_types.hpp"
#include "renderer/passes/surfels/cell_division.hpp"
#include "renderer/passes/surfels/surfel_placement.hpp"

namespace candela {

/// About how many surfels a group has, of `count` surfels that are wanted; 1: there are no groups.
[[nodiscard]] constexpr std::uint32_t surfels_a_group(std::uint32_t count) {
    return std::max((count + most_branches - 1) / most_branches, 1U);
}

/// The branches that a set's surfels are on, as cells: each has a surfel for a point, and its own surfel is
/// at the one nearest to their mean position. Without those that emit light. Their ids are all 0.
[[nodiscard]] SurfelSet branches_of(const SurfelSet& set);

/// Surfels in groups: those of a group follow each other, as the groups do, and emitting surfels are last.
struct GroupedSurfels {
    SurfelSet set;
    std::vector<gpu::SurfelGroup> groups;  ///< of all surfels but those that emit light
};

/// The surfels in groups, each of which far pixels see as one. A group is a part of a branch: what its middle
/// surfel sees, so that light on one side of a wall is not sent on from the other. Surfels that are in no
/// part are groups of one. `branches`: of the set, divided into `parts`.
[[nodiscard]] GroupedSurfels grouped(const SurfelSet& set, const SurfelSet& branches,
                                     std::span<const CellDivision> parts);

}  // namespace candela
