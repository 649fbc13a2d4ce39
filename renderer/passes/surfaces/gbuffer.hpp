#pragma once

#include <candela/graph/frame_graph.hpp>
#include "renderer/gpu/gpu.hpp"
#include "renderer/passes/scene/scene_upload.hpp"
#include "renderer/passes/view/view.hpp"

namespace candela {

/// Material, normal and depth of the visible solid surfaces.
struct Gbuffer {
    TextureHandle albedo;  ///< rgba16f, linear
    TextureHandle normal;  ///< rg32f, octahedral encoding, world space
    TextureHandle depth;   ///< depth32f, reversed; 0 where there is no surface
};

/// Declares the textures of `size` pixels, as attachments that `pass` writes.
[[nodiscard]] Gbuffer write_gbuffer(FrameGraph& graph, Pass& pass, glm::uvec2 size);

/// Adds node `gbuffer` (raster): the opaque and masked surfaces, without holes of masks. Depends on meshes,
/// materials and view. Textures of `view.size` pixels. The octahedral encoding of normals is that of Cigolle
/// et al. (2014): shaders/maths.glsl.
[[nodiscard]] Gbuffer add_gbuffer(FrameGraph& graph, Gpu& gpu, const SceneData& scene, const ViewData& view);

}  // namespace candela
