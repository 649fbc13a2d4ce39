#pragma once

#include <glm/mat4x4.hpp>
#include <vector>

#include <candela/graph/frame_graph.hpp>
#include "engine/bvh/box.hpp"
#include "renderer/gpu/gpu.hpp"
#include "renderer/passes/scene/scene_upload.hpp"
#include "renderer/passes/view/view.hpp"

namespace candela {

/// Whether a box is certainly outside the view: all its corners lie outside one of the six planes of the view
/// volume.
[[nodiscard]] bool is_outside(const Box& box, const glm::mat4& clip_from_box);

/// The draws of the layout; the instance count is 0 for those outside the view.
[[nodiscard]] std::vector<gpu::DrawCommand> visible_draws(const SceneLayout& layout,
                                                          const ScenePlacement& placement,
                                                          const CameraView& view);

/// Adds node `view-cull` (CPU, then upload): frustum culling of draws by bounding boxes. Returns the scene
/// for passes that draw what the camera sees; passes that draw for lights use the whole scene. Depends on the
/// scene's layout and placement and on the camera.
[[nodiscard]] SceneData add_view_cull(FrameGraph& graph, const Gpu& gpu, const SceneData& scene,
                                      ValueHandle<CameraView> camera);

}  // namespace candela
