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
/// Part number of points that another surface lies on: is_covered.
inline constexpr std::uint8_t covered_part = most_cell_parts + 1;

/// Of points that are as near to a place as each other, rounding must not choose, also where a cell moves:
/// another is nearer only if its distance is less than this times the least one before.
inline constexpr float distinctly = 0.99F;

/// Whether cells that emit light are divided. Each pixel has rays to all of them: where there are many, few
/// rays matter more than what they reflect.
[[nodiscard]] inline bool divides_emitters(const SurfelSet& set) {
    return set.emitting_count <= 2 * emitting_surfels(0);
}

/// How a cell is divided: each part has a surfel of its own. That of part 0 is the surfel of the cell.
struct CellDivision {
    std::vector<std::uint8_t> part_of;  ///< by point of the cell
    /// By part from 1 on: the point of the cell where its surfel is.
    std::array<std::uint32_t, most_cell_parts> middles{};
    /// By part: metres by which its surfel is raised along its normal, to the height of the part's highest
    /// point: what hides a pit of a rough surface must not hide all of it.
    std::array<float, most_cell_parts> lifts{};
    bool operator==(const CellDivision&) const = default;
};

/// Divides the cell of a surfel, in world space. Light that falls on one side of a wall that stands on the
/// cell must not be sent on from the other side, where it would have leaked through the wall. A part has the
/// points that its surfel sees, if their normals have a cosine of at least 0.7. Rays between them run above
/// the surface, as it may be curved within a cell: by 0.25 of the cell's width, or half of the way to what is
/// above. Each further surfel is at the point nearest to the centroid of those that are still in no part.
/// After most_cell_parts, those that are left are in none. Surfaces that lie on each other, up to 0.1 mm
/// apart or as far as rays start above them, are one: only points of the front one are in a part. Cells that
/// emit light have one part unless divides_emitters. `order`: order_of_solids; empty: no surface lies on
/// another. `ray_offset`: SceneMetrics::ray_offset.
[[nodiscard]] CellDivision divide_cell(const SurfelSet& set, std::size_t surfel, const TracedScene& scene,
                                       std::span<const std::uint32_t> order, float ray_offset);

/// The box around everything that divide_cell asks for: where nothing moves in it, the division stays.
[[nodiscard]] Box box_of_division(const SurfelSet& set, std::size_t surfel, float ray_offset);

/// The parts, as surfels with the points of their cells, in the order of the cells. Points that are in no
/// part are left out; but of cells that emit light, whose points send it one by one, those that face
/// elsewhere than all parts join the one that faces most like them. `cells`: by surfel of the set.
[[nodiscard]] SurfelSet divided(const SurfelSet& set, std::span<const CellDivision> cells);

}  // namespace candela
