#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "renderer/gpu/gpu_types.hpp"
#include "renderer/passes/surfels/patch_cut.hpp"
#include "renderer/passes/surfels/patch_tree.hpp"
#include "renderer/passes/surfels/scene_surfaces.hpp"
#include "renderer/passes/surfels/surfel_focus.hpp"

namespace candela {

/// Surfels: points on the scene's surfaces that gather light and reflect it. Each represents a cell, the part
/// of the surface around it, which is described by sample points.
struct SurfelSet {
    std::vector<gpu::Surfel> surfels;
    std::vector<gpu::CellPoint> points;  ///< of the cells, in the order of the surfels
    std::vector<std::uint64_t> ids;      ///< by surfel: equal ones are of the same cell of the same item
    std::vector<std::uint64_t> patches;  ///< the same, however much of the other items it stands for
    std::vector<std::uint32_t> item_of;  ///< by surfel: index into SceneGeometry::items
    std::vector<SurfacePoint> surfel_places;
    std::vector<SurfacePoint> point_places;
    std::uint32_t emitting_count = 0;  ///< surfels that emit light: the last ones
    PatchCut cut;                      ///< whose cells they are
    ChangesLeft left;                  ///< until it is the cut that is wanted
};

/// About how many points a cell has, of surfels that only reflect light and of those that emit it; fewer of
/// these where there are more than emitting_surfels, but as many as of the others.
inline constexpr std::uint32_t points_a_surfel = 16;
inline constexpr std::uint32_t points_an_emitter = 64;

/// About how many surfels are placed on surfaces that emit light, in addition to `count` on the others and
/// to the first one of each item. They light the scene directly, so that their number determines how smooth
/// soft shadows are. They have no depth maps, and each pixel traces rays to its share of them.
[[nodiscard]] constexpr std::uint32_t emitting_surfels(std::uint32_t count) {
    return std::max(count / 8, 64U);
}

/// Most items that emit light and have surfels of their own. Of more, some also stand for others.
inline constexpr std::uint32_t most_emitting_items = 1024;

/// Whether so many items are too many for `count` surfels, so that one stands for several.
[[nodiscard]] constexpr bool shares_items(std::size_t items, std::uint32_t count) {
    constexpr std::uint32_t few_items = 16;  // they have cells of their own in any case
    return items > std::max(count / 4, few_items);
}

/// A point of surfaces that reflect light, and how much views would see of an error in its light.
struct GuidePoint {
    SurfacePoint place;
    float area = 0.0F;   ///< m², of the surface that it stands for
    float share = 0.0F;  ///< in any unit
    bool operator==(const GuidePoint&) const = default;
};

/// How many surfels are placed at most on surfaces that do not emit light, and on those that do.
struct SurfelCounts {
    std::uint32_t reflecting = 0;
    std::uint32_t emitting = 0;
    bool operator==(const SurfelCounts&) const = default;
};

/// The cut that a set's follows.
struct LastCut {
    const PatchCut* cut = nullptr;  ///< null: the set may be any
    std::uint32_t most_new = 0;     ///< CutLimits::new_cells, of each kind of surfels
    double gain = 1.0;              ///< CutLimits
};

/// Places surfels on the surfaces that reflect light, and likewise on those that emit it, on both sides
/// where the material is double-sided. The surfaces of an item are the root of a tree of patches. A cell is a
/// patch: the trees are cut where the sum of shares (GuidePoint) and of area times density (density_at) is
/// greatest, weighted by how much surfaces bend (Patch::bend), until there are as many cells as are wanted.
/// Each part of the cell has a sample point, unless that is in a hole of a mask: the area of the cell is that
/// of the parts whose points are on the surface. The point nearest to the cell's centre is its surfel. If
/// there are more than 16 items, and more than a quarter as many as surfels wanted, some, chosen at random,
/// also stand for others; of items that emit light, if there are more than most_emitting_items.
///
/// A patch has the same cell wherever the focus is. The set depends on the arguments of the constructor and
/// of `place` only: the trees are kept between calls just to save time.
class SurfelPlacement {
 public:
    SurfelPlacement(SceneSurfaces surfaces, std::uint32_t seed);
    SurfelPlacement(const SurfelPlacement&) = delete;
    SurfelPlacement& operator=(const SurfelPlacement&) = delete;
    ~SurfelPlacement() = default;

    [[nodiscard]] const SceneSurfaces& surfaces() const { return surfaces_; }

    /// `foci`: by item, in its shape's space; an item without any has the density of a focus everywhere.
    /// Empty: no item has any. `guide`: on these surfaces; empty: only area and density count. `last`: the
    /// trees are cut as then, but for few patches: see follow.
    [[nodiscard]] SurfelSet place(const SurfelCounts& counts, std::span<const std::vector<Focus>> foci = {},
                                  std::span<const GuidePoint> guide = {}, const LastCut& last = {});

 private:
    /// A cell that surfels are placed on.
    struct Cell {
        std::uint32_t patch = 0;
        double scale = 1.0;                   ///< how many times its area it stands for
        std::vector<std::uint32_t> guides{};  ///< indices of the guide's points in it
    };
    /// By what trees are cut.
    struct Weights {
        std::span<const std::vector<Focus>> foci;
        std::span<const GuidePoint> guide;
        double of_share = 0.0;
        double of_area = 1.0;
    };

    /// Cells, and the cut that they are of.
    struct CutCells {
        std::vector<Cell> cells;
        PatchCut cut;
        ChangesLeft left{};
    };
    /// How cells are cut, besides by their weights.
    struct Cutting {
        std::span<const GuidePoint> guide{};  // those that the cells list
        const PatchCut* within = nullptr;     // only what is opened there; null: all may be cut
        PatchCut* record = nullptr;           // null: none
    };

    void plant();
    [[nodiscard]] std::vector<std::uint32_t> roots_of(bool emitting);
    [[nodiscard]] Weights weights_of(std::span<const std::vector<Focus>> foci,
                                     std::span<const GuidePoint> guide) const;
    [[nodiscard]] double weight_of(const Cell& cell, const Weights& weights) const;
    [[nodiscard]] std::vector<Cell> share_items(const std::vector<std::uint32_t>& roots, double most,
                                                const Weights& weights) const;
    [[nodiscard]] std::vector<Cell> whole_items(const std::vector<std::uint32_t>& roots,
                                                const Weights& weights) const;
    [[nodiscard]] CutCells cells_on(const std::vector<std::uint32_t>& roots, const std::vector<Cell>& chosen,
                                    std::uint32_t count, const Weights& weights, const LastCut& last);
    [[nodiscard]] CutCells reflecting_cells(std::uint32_t count, const Weights& weights, const LastCut& last);
    [[nodiscard]] CutCells emitting_cells(std::uint32_t count, const Weights& weights, const LastCut& last);
    [[nodiscard]] CutCells cells_of(std::vector<Cell> whole, std::uint32_t count, const Weights& weights,
                                    const PatchCut* within);
    void split(std::vector<Cell>& cells, std::size_t index, std::span<const GuidePoint> guide) const;
    template <class Weight>
    [[nodiscard]] std::vector<Cell> cut(std::vector<Cell> cells, std::uint32_t count, const Weight& weigh,
                                        const Cutting& cutting);
    [[nodiscard]] std::vector<Cell> in_order(std::vector<Cell> cells, std::vector<std::uint32_t> whole) const;
    void append(SurfelSet& set, const Cell& cell, std::uint32_t points);

    SceneSurfaces surfaces_;
    std::uint32_t seed_;
    PatchTree tree_;
    std::vector<std::uint32_t> reflecting_;  // roots
    std::vector<std::uint32_t> emitting_;
};

}  // namespace candela
