#pragma once

#include <cstdint>
#include <vector>

#include "engine/graph/frame_graph.hpp"
#include "renderer/gpu.hpp"
#include "renderer/passes/scene_upload.hpp"
#include "renderer/passes/vpl_schedule.hpp"
#include "renderer/passes/vpl_trace.hpp"

namespace candela {

/// What the host tells of time: VPLs are brought up to date little by little, also where nothing else
/// changes.
struct VplClock {
    std::uint64_t epoch = 0;  ///< another one than before: all that is remembered is to be forgotten
    std::uint64_t round = 0;  ///< another one than before: work that is left is to go on
    bool operator==(const VplClock&) const = default;
};

/// Boxes around what differs between two states of a scene, as it was and as it is; blended surfaces do not
/// count, as light is not traced against them.
[[nodiscard]] std::vector<Box> moved_boxes(const SceneGeometry& before, const ScenePlacement& placed_before,
                                           const SceneGeometry& now, const ScenePlacement& placed_now);

/// What a schedule is made from.
struct RefreshSources {
    DueVpls all;  ///< the plan, with all of it due
    ValueHandle<LightTable> lights;
    BufferHandle<gpu::Light> light_buffer;
    ValueHandle<VplClock> clock;
};

/// Node `vpl-refresh` (compute, then CPU): keeps what still holds of the VPLs of the frame before, and
/// schedules what is to be made anew within the budget. Everything is made anew in its first run, in a new
/// epoch, after a change of settings, and for each further set of VPLs that refinement asks for; when
/// refinement falls back, the VPLs of the last set are kept and replaced within the budget. Where lights or
/// geometry changed it tests the paths on the GPU and waits for the result: one synchronisation in such a
/// frame, and another for the VPLs themselves where something moved and they have maps; none in others.
[[nodiscard]] DueVpls add_vpl_refresh(FrameGraph& graph, Gpu& gpu, const SceneData& scene,
                                      const Tracing& tracing, const RefreshSources& sources,
                                      const VplSettings& settings, bool has_maps);

}  // namespace candela
