#pragma once

#include <candela/graph/frame_graph.hpp>
#include "renderer/gpu/gpu.hpp"
#include "renderer/passes/scene/bvh.hpp"
#include "renderer/passes/scene/scene_upload.hpp"
#include "renderer/passes/view/view.hpp"

namespace candela {

/// Adds node `view-cull` (CPU, then upload): frustum culling of draws, of solid drawables by the hierarchy
/// over them, of the others by their bounding boxes. Draws outside the view get no instances. Returns the
/// scene for passes that draw what the camera sees; passes that draw for lights use the whole scene. Depends
/// on the scene's layout and placement and on the camera.
[[nodiscard]] SceneData add_view_cull(FrameGraph& graph, const Gpu& gpu, const SceneData& scene,
                                      const Tracing& tracing, ValueHandle<CameraView> camera);

}  // namespace candela
