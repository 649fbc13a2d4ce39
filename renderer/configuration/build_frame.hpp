#pragma once

#include <optional>

#include <candela/configuration.hpp>
#include <candela/graph/frame_graph.hpp>
#include "renderer/passes/indirect/vpl_reconstruct.hpp"
#include "renderer/passes/lights/light_lists.hpp"
#include "renderer/passes/lights/lights.hpp"
#include "renderer/passes/lights/shadow_maps.hpp"
#include "renderer/passes/scene/bvh.hpp"
#include "renderer/passes/view/refinement.hpp"
#include "renderer/passes/view/view.hpp"
#include "renderer/passes/vpls/vpl_trace.hpp"
#include "renderer/scene_check.hpp"

namespace candela {

/// Handles into the frame graph: values that the renderer sets before each frame, and results that reports
/// read.
struct FrameHandles {
    ValueHandle<ViewRequest> request;  ///< imported
    TextureHandle target;              ///< imported: its object is the GL name of a framebuffer
    ValueHandle<SceneMetrics> metrics;
    ValueHandle<LightTable> lights;
    ValueHandle<ShadowPlan> shadows;
    ValueHandle<DrawnShadows> drawn_shadows;
    /// Imported: see add_scene_motion; none without surfels.
    std::optional<ValueHandle<std::uint64_t>> epoch;
    std::optional<Vpls> vpls;                                      ///< none without indirect light
    std::optional<ValueHandle<RefinementClock>> refinement_clock;  ///< imported; none without refinement
    std::optional<ValueHandle<Refinement>> refinement;
    std::uint32_t interleave = 1;           ///< n: a pixel evaluates one in n² VPLs; 1: all of them
    std::optional<IndirectLight> indirect;  ///< none if `interleave` is 1
    std::optional<LightLists> lists;        ///< none if every surface evaluates all lights
};

/// Sizes of a frame, in pixels.
struct FrameExtent {
    glm::uvec2 size;                     ///< of the picture that is shaded
    glm::uvec2 target;                   ///< of the target, to which that picture is scaled
    std::uint32_t least_interleave = 1;  ///< lower bound for the interleave factor n
};

/// What a world contains, as far as the passes of its frames depend on it.
struct FrameContents {
    bool emitters = false;  ///< surfaces that emit light
    bool suns = false;      ///< directional lights that cast shadows, or a sky that may have suns
    bool sky = false;       ///< an Environment that is not black
    bool operator==(const FrameContents&) const = default;
};

struct WorldContents {
    FrameContents of_frame;
    bool depend_on_transforms = false;  ///< whether `of_frame` may be another after a Transform has changed
};
/// What the world contains of what `check` accepts.
[[nodiscard]] WorldContents contents_of(const World& world, SceneCheck& check);

/// Declares all passes of a frame with a valid configuration and one size. `gpu` must outlive the graph.
/// Throws gl::ProgramError if a shader does not compile.
[[nodiscard]] FrameHandles build_frame(FrameGraph& graph, Gpu& gpu, const Configuration& configuration,
                                       const FrameExtent& extent, const FrameContents& contents);

}  // namespace candela
