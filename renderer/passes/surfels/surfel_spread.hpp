#pragma once

#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <memory>
#include <optional>
#include <vector>

#include <candela/configuration.hpp>
#include <candela/graph/frame_graph.hpp>
#include "renderer/passes/scene/scene_upload.hpp"
#include "renderer/passes/surfels/surfel_focus.hpp"
#include "renderer/passes/surfels/surfel_placement.hpp"
#include "renderer/passes/view/refinement.hpp"

namespace candela {

/// The shape of an item: its local-to-world matrix without rotation and translation. It is the upper
/// triangular Cholesky factor of the Gram matrix MᵀM, rounded to about four digits, so that it stays the
/// same, bit for bit, while the item rotates. The first row is negated for mirrored items. For flat items,
/// which have no inverse, it is the upper left 3 × 3 part of `world`.
[[nodiscard]] glm::mat3 shape_of(const glm::mat4& world);

/// What the trees that surfels are placed with depend on. Each item is in its own space, transformed only by
/// its shape matrix: see shape_of.
struct PlacementKey {
    SceneGeometry geometry;
    std::vector<glm::mat3> shapes;
    std::uint32_t seed = 0;
    bool operator==(const PlacementKey&) const = default;
};

/// Where the light comes from that the views see: see add_surfel_guide.
struct SurfelGuide {
    PlacementKey key;                ///< of the triangles that the points are on
    std::vector<GuidePoint> points;  ///< of a coarse set's cells
    bool operator==(const SurfelGuide&) const = default;

    /// Whether it tells about these items. Seeds may differ.
    [[nodiscard]] bool is_of(const PlacementKey& other) const {
        return key.geometry == other.geometry && key.shapes == other.shapes;
    }
};

/// What the set of surfels depends on besides.
struct SetKey {
    SurfelCounts counts;
    std::vector<std::vector<Focus>> foci;  // by item, in its shape space
    std::vector<GuidePoint> guide;
    bool operator==(const SetKey&) const = default;
};

/// The last placement of the surfels, in the items' shape spaces.
struct SpreadSurfels {
    PlacementKey placement_key;
    SetKey key;
    std::shared_ptr<SurfelPlacement> placement;
    std::shared_ptr<const SurfelSet> set;
    bool operator==(const SpreadSurfels&) const = default;
};

/// The surfels in world space, of items where they are now, and moved with the triangles of deformed ones.
[[nodiscard]] SurfelSet placed_in_world(const SpreadSurfels& spread, const ScenePlacement& placement);

/// Set by the renderer before each frame, with VplSettings::updates.
struct UpdateClock {
    std::uint32_t limit = 0;  ///< VplSettings::updates: at least 1
    std::uint64_t round = 0;  ///< a new value asks for more of what waits
    bool moves = false;       ///< the world or a view has changed since the last frame
    bool operator==(const UpdateClock&) const = default;
};

/// What surfels are placed by.
struct SpreadInputs {
    ValueHandle<std::vector<Focus>> foci;
    std::optional<ValueHandle<SurfelGuide>> guide{};  ///< none: by area and foci alone
    std::optional<ValueHandle<UpdateClock>> clock{};  ///< none: at once
};

/// Adds node `surfel-spread` (CPU): places the surfels of a set on the items, densely in the foci and where
/// the light comes from that is seen. Surfels belong to the items of the scene and move with them: all are
/// placed again when an item is added, removed or changes its shape. With a clock whose limit they exceed,
/// only half as many as that are replaced in a frame, so that the others can be traced, and while anything
/// moves only where it is well worth it: see follow. Depends on the scene's layout and placement, on foci,
/// guide, clock and the set, and with a clock on its own last result; without, that saves time.
[[nodiscard]] ValueHandle<SpreadSurfels> add_surfel_spread(FrameGraph& graph, const SceneData& scene,
                                                           const SurfelSetChoice& set,
                                                           const SpreadInputs& inputs,
                                                           const VplSettings& settings);

}  // namespace candela
