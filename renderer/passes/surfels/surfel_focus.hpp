#pragma once

#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include <candela/graph/frame_graph.hpp>
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

/// Rays from the eye through a grid of points in the picture.
[[nodiscard]] std::vector<Ray> rays_through(const CameraView& view, const glm::ivec2& grid);

struct SurfelFoci {
    ValueHandle<std::vector<Focus>> foci;
    ValueHandle<Focus> of_maps;  ///< focus_of_maps
};

/// Adds node `surfel-focus` (CPU): where surfels should be dense, one sphere for each view. It is around the
/// eye. Its radius is 1.5 times a distance, the greatest of three medians that rays find: of the surfaces in
/// the picture, of those all around the eye, and, indoors, from what is in the picture to what lights it.
/// Radius and centre change in steps, so that all surfels stay while a camera moves a little.
/// There are no spheres if `count` surfels, spread evenly, are dense enough for a view. Depends on `requests`
/// (imported: all views), Camera, Transform, and the scene's layout and placement.
[[nodiscard]] SurfelFoci add_surfel_focus(FrameGraph& graph, const SceneData& scene, const Tracing& tracing,
                                          ValueHandle<std::vector<ViewRequest>> requests,
                                          std::uint32_t count);

}  // namespace candela
