#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/bvh/box.hpp"
#include "renderer/passes/scene/traced_scene.hpp"
#include "renderer/passes/surfels/surfel_placement.hpp"

namespace candela {

/// Most parts of a cell, and the part number of points that are in none.
inline constexpr std::uint8_t most_cell_parts = 4;

/// Of points that are as near to a place as each other, rounding must not choose, also where a cell moves:
/// another is nearer only if its distance is less than this times the least one before.
inline constexpr float distinctly = 0.99F;

/// How a cell is divided: each part has a surfel of its own. That of part 0 is the surfel of the cell.
struct CellDivision {
    std::vector<std::uint8_t> part_of;  ///< by point of the cell
    /// By part from 1 on: the point of the cell where its surfel is.
    std::array<std::uint32_t, most_cell_parts> middles{};
    bool operator==(const CellDivision&) const = default;
};

/// Divides the cell of a surfel, in world space. Light that falls on one side of a wall that stands on the
/// cell must not be sent on from the other side, where it would have leaked through the wall. A part has the
/// points that its surfel sees, if their normals have a cosine of at least 0.7. Rays between them run above
/// the surface, as it may be curved within a cell: by 0.25 of the cell's width, or half of the way to what is
/// above. Each further surfel is at the point nearest to the centroid of those that are still in no part.
/// After most_cell_parts, those that are left are in none. `ray_offset`: SceneMetrics::ray_offset.
[[nodiscard]] CellDivision divide_cell(const SurfelSet& set, std::size_t surfel, const TracedScene& scene,
                                       float ray_offset);

/// The box around everything that divide_cell asks for: where nothing moves in it, the division stays.
[[nodiscard]] Box box_of_division(const SurfelSet& set, std::size_t surfel, float ray_offset);

/// The parts, as surfels with the points of their cells, in the order of the cells. Points that are in no
/// part are left out. `cells`: by surfel of the set.
[[nodiscard]] SurfelSet divided(const SurfelSet& set, std::span<const CellDivision> cells);

}  // namespace candela
