#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <candela/configuration.hpp>
#include <candela/extension.hpp>
#include <candela/graph/frame_graph.hpp>
#include <candela/report.hpp>
#include "renderer/passes/indirect/vpl_error.hpp"
#include "renderer/passes/indirect/vpl_reconstruct.hpp"
#include "renderer/passes/lights/light_lists.hpp"
#include "renderer/passes/lights/lights.hpp"
#include "renderer/passes/receivers/receivers.hpp"
#include "renderer/passes/scene/bvh.hpp"
#include "renderer/passes/scene/scene_check.hpp"
#include "renderer/passes/surfaces/host_surfaces.hpp"
#include "renderer/passes/surfels/surfel_updates.hpp"
#include "renderer/passes/view/refinement.hpp"
#include "renderer/passes/view/view.hpp"
#include "renderer/passes/vpls/vpls.hpp"

namespace candela {

/// Handles of a view in the frame graph: values that the renderer sets before each frame, and results.
struct ViewHandles {
    ValueHandle<ViewRequest> request;                    ///< imported
    ValueHandle<Target> target;                          ///< imported
    TextureHandle picture;                               ///< imported: what is drawn to `target`
    std::optional<HostSurfaceInputs> host;               ///< imported; none: Candela draws the surfaces
    ValueHandle<CameraView> camera;                      ///< with refinement's samples
    std::optional<ValueHandle<std::uint32_t>> averaged;  ///< see Refined; none without refinement
    std::uint32_t interleave = 1;            ///< n: a pixel evaluates one in n² VPLs; 1: all of them
    std::optional<IndirectLight> indirect;   ///< none if `interleave` is 1
    std::optional<LightLists> lists;         ///< none if every surface evaluates all lights
    std::optional<VplErrorSamples> samples;  ///< none without VPLs, or if nobody asked for the error
    ViewFrame parts;                         ///< what is kept, as far as it was asked for
    std::vector<std::string> host_passes;    ///< names of the passes of extensions
};

/// Handles into the frame graph, of all views.
struct FrameHandles {
    ValueHandle<SceneMetrics> metrics;
    SceneLights lights;
    /// Imported: see add_scene_motion; none without surfels.
    std::optional<ValueHandle<std::uint64_t>> epoch;
    /// Imported: of all views, with the size of the target and without jitter; none without surfels.
    std::optional<ValueHandle<std::vector<ViewRequest>>> requests;
    std::optional<Vpls> vpls;                              ///< none without indirect light
    std::optional<ValueHandle<UpdateClock>> update_clock;  ///< imported; none without VplSettings::updates
    std::optional<ValueHandle<UpdateClock>> map_clock;     ///< imported: FrameSchedule::map_clock; likewise
    std::optional<ValueHandle<bool>> guide_waits;  ///< imported: SurfelGuide stays in this frame; likewise
    std::optional<ValueHandle<WaitingSurfels>> waiting;  ///< SurfelUpdates::waiting, likewise
    /// The same of the set that is prepared; none if none is.
    std::optional<ValueHandle<WaitingSurfels>> waiting_of_next;
    std::optional<ValueHandle<RefinementClock>> refinement_clock;  ///< imported; none without refinement
    std::optional<ValueHandle<Refinement>> refinement;             ///< likewise
    /// Imported: Renderer::set_receivers; none if there are none.
    std::optional<ValueHandle<std::vector<Receiver>>> receivers;
    std::optional<ReceivedLight> received;  ///< none either if no light is shown
    std::vector<ViewHandles> views;         ///< at least one
};

/// What the passes of a view depend on.
struct ViewShape {
    glm::uvec2 target{1};         ///< of the target, pixels
    bool host_surfaces = false;   ///< the host has drawn the surfaces
    bool host_material = false;   ///< and their material: HostSurfaces::material
    FrameParts keep{};            ///< see RenderView::keep
    bool estimate_error = false;  ///< see RenderView::estimate_error
    bool operator==(const ViewShape&) const = default;
};

/// What a world contains, as far as the passes of its frames depend on it.
struct FrameContents {
    SurfaceKinds surfaces{.opaque = true};  ///< as long as no world is known, opaque ones are expected
    bool emitters = false;                  ///< surfaces that emit light
    bool glossy = false;                    ///< surfaces that may be glossy: is_glossy
    bool bumpy = false;                     ///< surfaces with normal or occlusion textures: is_bumpy
    bool second_uvs = false;                ///< surfaces that need them: uses_second_uvs
    bool glass = false;                     ///< surfaces that light passes through: is_glass
    bool sky = false;                       ///< an Environment that is not black
    bool shares_items = false;              ///< there are so many objects that a surfel stands for several
    bool operator==(const FrameContents&) const = default;
};

struct WorldContents {
    FrameContents of_frame;
    bool depend_on_transforms = false;  ///< whether `of_frame` may be another after a Transform has changed
};
/// What the world contains of what `check` accepts. `vpls`: VplSettings::count.
[[nodiscard]] WorldContents contents_of(const World& world, SceneCheck& check, std::uint32_t vpls);

/// Sets of surfels take turns: see SurfelSetChoice.
struct SurfelTurn {
    std::uint32_t place = 0;     ///< of the set that lights the frame
    bool prepares_next = false;  ///< the frame also makes a part of the next set
    bool operator==(const SurfelTurn&) const = default;
};
/// Whether they do with this configuration: where the time of a frame is bounded, the next set is made in
/// parts.
[[nodiscard]] bool takes_turns(const Configuration& configuration);

/// What the passes of a frame depend on.
struct FrameShape {
    std::vector<ViewShape> views{1};  ///< at least one
    Quality quality;                  ///< of all views
    FrameContents contents;
    bool receivers = false;  ///< the host has any
    SurfelTurn turn{};
    bool operator==(const FrameShape&) const = default;
};

/// Declares all passes of a frame with a valid configuration. VPLs and all that is independent of the camera
/// are shared by the views; the names of the passes and resources of view 2, 3, ... end in that number. `gpu`
/// must outlive the graph; its programs are to be compiled before the graph runs. Throws gl::ProgramError if
/// a shader file is missing, and passes on what an extension throws.
[[nodiscard]] FrameHandles build_frame(FrameGraph& graph, Gpu& gpu, const Configuration& configuration,
                                       const FrameShape& shape, std::span<const Extension> extensions);

}  // namespace candela
