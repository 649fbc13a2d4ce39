#pragma once

#include <optional>

#include "engine/graph/frame_graph.hpp"
#include "renderer/configuration/configuration.hpp"
#include "renderer/passes/bvh.hpp"
#include "renderer/passes/light_lists.hpp"
#include "renderer/passes/lights.hpp"
#include "renderer/passes/refinement.hpp"
#include "renderer/passes/shadow_maps.hpp"
#include "renderer/passes/view.hpp"
#include "renderer/passes/vpl_reconstruct.hpp"
#include "renderer/passes/vpl_trace.hpp"

namespace candela {

/// What the host feeds a frame with, and what a report reads from it.
struct FrameHandles {
    ValueHandle<ViewRequest> request;  ///< imported
    TextureHandle target;              ///< imported: a framebuffer's name
    ValueHandle<SceneMetrics> metrics;
    ValueHandle<LightTable> lights;
    ValueHandle<ShadowPlan> shadows;
    ValueHandle<DrawnShadows> drawn_shadows;
    std::optional<ValueHandle<std::uint64_t>>
        epoch;                 ///< imported: see add_scene_motion; none without surfels
    std::optional<Vpls> vpls;  ///< none without indirect light
    std::optional<ValueHandle<RefinementClock>> refinement_clock;  ///< imported; none without refinement
    std::optional<ValueHandle<Refinement>> refinement;
    std::uint32_t interleave = 1;           ///< 1: each pixel asks all VPLs as it is shaded
    std::optional<IndirectLight> indirect;  ///< none where interleave is 1
    std::optional<LightLists> lists;        ///< none where all surfaces visit all lights
};

/// What is rendered, in pixels.
struct FrameExtent {
    glm::uvec2 size;                     ///< that are shaded
    glm::uvec2 target;                   ///< to which they are scaled
    std::uint32_t least_interleave = 1;  ///< where the configuration asks for less
};

/// Declares the frame that a valid configuration asks for, at one size.
/// Throws gl::ProgramError if a shader does not compile.
[[nodiscard]] FrameHandles build_frame(FrameGraph& graph, Gpu& gpu, const Configuration& configuration,
                                       const FrameExtent& extent);

}  // namespace candela
