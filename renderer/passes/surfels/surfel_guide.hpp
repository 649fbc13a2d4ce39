#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include <candela/graph/frame_graph.hpp>
#include "renderer/gpu/gpu.hpp"
#include "renderer/passes/scene/bvh.hpp"
#include "renderer/passes/surfels/surfel_spread.hpp"
#include "renderer/passes/surfels/surfel_visibility.hpp"
#include "renderer/passes/view/view.hpp"
#include "renderer/passes/vpls/vpls.hpp"

namespace candela {

/// How many surfels guide the placement of `count` others.
[[nodiscard]] constexpr std::uint32_t guiding_surfels(std::uint32_t count) {
    return std::min(count, 512U);
}

/// Adds node `surfel-guide` (CPU and compute): how much the views would see of an error in the light of each
/// cell of a coarse set of surfels. Rays through the pictures count how often each cell is seen; its share of
/// the picture is then given to the cells that light it, by the form factors and their flux (one step of
/// importance; shaders/README.md, "Guide"). The result is read back, for which the CPU waits. `spread`,
/// `visibility` and `lit`: the coarse set, which has no more surfels than MOST_COLUMNS. Depends on them, on
/// `requests` (all views), Camera, Transform and BVH.
[[nodiscard]] ValueHandle<SurfelGuide> add_surfel_guide(FrameGraph& graph, Gpu& gpu, const SceneData& scene,
                                                        const Tracing& tracing,
                                                        ValueHandle<std::vector<ViewRequest>> requests,
                                                        ValueHandle<SpreadSurfels> spread,
                                                        const SurfelVisibility& visibility, const Vpls& lit);

}  // namespace candela
