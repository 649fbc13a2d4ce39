#pragma once

#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include <candela/graph/frame_graph.hpp>
#include "renderer/passes/lights/light_table.hpp"
#include "renderer/passes/scene/bvh.hpp"
#include "renderer/passes/scene/scene_upload.hpp"
#include "renderer/passes/view/view.hpp"

namespace candela {

/// A sphere in which surfels are densest. Outside it, their density falls with the third power of the
/// distance r from its centre: a cell of area a on the ground has the form factor a h / (π r³) at the height
/// h above the centre, which is then the same for all cells, however far away.
struct Focus {
    glm::vec3 centre{0.0F};
    float radius = 0.0F;  ///< metres
    bool operator==(const Focus&) const = default;
};

/// Density of surfels at a place, in (0, 1]: 1 in any of the spheres, or if there are none.
[[nodiscard]] float density_at(std::span<const Focus> foci, const glm::vec3& place);

/// What the depth maps of far surfels see alone: a sphere that encloses the only focus and has at least twice
/// its radius r, a power of two, so that it has most of what is visible. Its centre is rounded to a multiple
/// of r / 4 along each axis, and thus less than 0.22 r off, so that the maps stay while the focus moves less.
/// Radius 0: there are no or several foci, and maps see everything.
[[nodiscard]] Focus focus_of_maps(std::span<const Focus> foci);

/// Whether foci and guide are those of the scene and the views, if they may be held.
struct FocusState {
    bool held = false;     ///< they should be others, and will be when nothing moves and no surfel waits
    bool renewed = false;  ///< they may be others than in the last frame, though no view has moved
    bool operator==(const FocusState&) const = default;
};

/// Rays from the eye through a grid of points in the picture.
[[nodiscard]] std::vector<Ray> rays_through(const CameraView& view, const glm::ivec2& grid);

struct SurfelFoci {
    ValueHandle<std::vector<Focus>> foci;
    ValueHandle<Focus> of_maps;                    ///< focus_of_maps
    std::optional<ValueHandle<FocusState>> state;  ///< with a clock
    std::optional<ValueHandle<bool>> holds_guide;  ///< with a clock: SurfelGuide stays in this frame
};

/// Set by the renderer before each frame, with VplSettings::updates.
struct UpdateClock {
    std::uint32_t limit = 0;  ///< VplSettings::updates: at least 1
    std::uint64_t round = 0;  ///< a new value asks for more of what waits
    bool waits = false;       ///< surfels wait to be traced: SurfelUpdates::waiting after the last frame
    bool operator==(const UpdateClock&) const = default;
};

/// What decides whether foci and guide stay.
struct FocusClock {
    std::optional<ValueHandle<UpdateClock>> updates{};  ///< none: they never do
    std::optional<ValueHandle<LightTable>> lights{};    ///< that a guide depends on; none: there is no guide
};

/// Adds node `surfel-focus` (CPU): where surfels should be dense, one sphere for each view. It is around the
/// eye. Its radius is 1.5 times a distance, the greatest of three medians that rays find: of the surfaces in
/// the picture, of those all around the eye, and, indoors, from what is in the picture to what lights it.
/// Radius and centre change in steps, so that all surfels stay while a camera moves a little.
/// There are no spheres if `count` surfels, spread evenly, are dense enough for a view. With a clock, the
/// spheres stay while things move or surfels wait, unless a view moves: with others, there would be other
/// surfels to trace. The guide of surfels (add_surfel_guide) stays as well, also while lights or views move,
/// if there are more surfels than may be traced in a frame, but not for more than 16 frames in which
/// something moves, nor where a view has moved by an eighth of the distance above or turned by 15°. Depends
/// on `requests` (imported: all views), Camera, Transform, the scene's layout and placement, and the clock;
/// with a clock also on light and on its own last result.
[[nodiscard]] SurfelFoci add_surfel_focus(FrameGraph& graph, const SceneData& scene, const Tracing& tracing,
                                          ValueHandle<std::vector<ViewRequest>> requests, std::uint32_t count,
                                          const FocusClock& clock);

}  // namespace candela
