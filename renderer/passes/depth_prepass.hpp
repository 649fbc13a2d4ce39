#pragma once

#include "engine/graph/frame_graph.hpp"
#include "renderer/gpu.hpp"
#include "renderer/passes/scene_upload.hpp"
#include "renderer/passes/view.hpp"

namespace candela {

/// Node `depth-prepass`: depth of the solid surfaces, depth32f, reversed.
[[nodiscard]] TextureHandle add_depth_prepass(FrameGraph& graph, Gpu& gpu, const SceneData& scene,
                                              ValueHandle<CameraView> view, glm::uvec2 size);

}  // namespace candela
