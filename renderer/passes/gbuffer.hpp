#pragma once

#include "engine/graph/frame_graph.hpp"
#include "renderer/gpu.hpp"
#include "renderer/passes/scene_upload.hpp"
#include "renderer/passes/view.hpp"

namespace candela {

/// The surfaces that the view sees.
struct Gbuffer {
    TextureHandle albedo;  ///< rgba16f, linear
    TextureHandle normal;  ///< rg32f, octahedral, world space
    TextureHandle depth;   ///< depth32f, reversed; 0 where there is nothing
};

/// Node `gbuffer`.
[[nodiscard]] Gbuffer add_gbuffer(FrameGraph& graph, Gpu& gpu, const SceneData& scene, const FrameView& view,
                                  glm::uvec2 size);

}  // namespace candela
