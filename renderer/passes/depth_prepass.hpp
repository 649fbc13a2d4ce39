#pragma once

#include "engine/graph/frame_graph.hpp"
#include "renderer/gpu.hpp"
#include "renderer/passes/scene_upload.hpp"
#include "renderer/passes/view.hpp"

namespace candela {

/// The surfaces that the view sees, without what they are made of.
struct VisibleSurfaces {
    TextureHandle depth;   ///< depth32f, reversed; 0 where there is nothing
    TextureHandle normal;  ///< rg32f, octahedral, world space
};

/// Node `depth-prepass`: depth and normals of the solid surfaces.
[[nodiscard]] VisibleSurfaces add_depth_prepass(FrameGraph& graph, Gpu& gpu, const SceneData& scene,
                                                const FrameView& view, glm::uvec2 size);

}  // namespace candela
