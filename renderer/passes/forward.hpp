#pragma once

#include <optional>

#include "engine/graph/frame_graph.hpp"
#include "renderer/gpu.hpp"
#include "renderer/passes/lighting.hpp"
#include "renderer/passes/scene_upload.hpp"
#include "renderer/passes/view.hpp"

namespace candela {

/// What a shading path leaves of the solid surfaces.
struct ShadedSurfaces {
    TextureHandle radiance;  ///< rgba32f, alpha 1 where there is a surface
    TextureHandle depth;     ///< depth32f, reversed; 0 where there is nothing
};

/// Node `forward`: rasterises the surfaces and shades them at once. With the depth of a pre-pass only those
/// are shaded that are seen in the end.
[[nodiscard]] ShadedSurfaces add_forward(FrameGraph& graph, Gpu& gpu, const SceneData& scene,
                                         const Lighting& lighting, const FrameView& view,
                                         std::optional<TextureHandle> prepass_depth, glm::uvec2 size);

}  // namespace candela
