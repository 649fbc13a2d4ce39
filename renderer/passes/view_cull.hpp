#pragma once

#include <glm/mat4x4.hpp>
#include <vector>

#include "engine/bvh/box.hpp"
#include "engine/graph/frame_graph.hpp"
#include "renderer/gpu.hpp"
#include "renderer/passes/scene_upload.hpp"
#include "renderer/passes/view.hpp"

namespace candela {

/// Whether nothing of a box can be in the view: all its corners lie beyond one of the six planes.
[[nodiscard]] bool is_outside(const Box& box, const glm::mat4& clip_from_box);

/// The layout's draws, those of primitives outside the view without an instance.
[[nodiscard]] std::vector<gpu::DrawCommand> visible_draws(const SceneLayout& layout,
                                                          const ScenePlacement& placement,
                                                          const CameraView& view);

/// Node `view-cull` (CPU). Gives the scene for passes that draw what the camera sees; what lights see is the
/// whole scene's.
[[nodiscard]] SceneData add_view_cull(FrameGraph& graph, const Gpu& gpu, const SceneData& scene,
                                      ValueHandle<CameraView> camera);

}  // namespace candela
