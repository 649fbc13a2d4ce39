#pragma once

#include "engine/graph/frame_graph.hpp"
#include "renderer/gpu.hpp"
#include "renderer/passes/lighting.hpp"
#include "renderer/passes/scene_upload.hpp"
#include "renderer/passes/view.hpp"

namespace candela {

/// Node `forward`: rasterises the surfaces and shades them at once. Gives radiance, rgba32f.
[[nodiscard]] TextureHandle add_forward(FrameGraph& graph, Gpu& gpu, const SceneData& scene,
                                        const Lighting& lighting, ValueHandle<CameraView> view,
                                        glm::uvec2 size);

}  // namespace candela
