#pragma once

#include <cstdint>
#include <optional>

#include <candela/graph/frame_graph.hpp>
#include <candela/scene/components.hpp>
#include "renderer/gpu/gpu.hpp"
#include "renderer/gpu/gpu_types.hpp"
#include "renderer/passes/scene/material_binding.hpp"
#include "renderer/passes/scene/scene_layout.hpp"

namespace candela {

/// The scene on the GPU, with its description on the CPU.
struct SceneData {
    ValueHandle<ScenePlacement> placement;
    ValueHandle<SceneLayout> layout;
    BufferHandle<Vertex> vertices;
    BufferHandle<std::uint32_t> indices;  ///< relative to the draw's base vertex
    /// 0, 1, 2, ...: a per-instance vertex attribute, which gives shaders the draw's base instance.
    BufferHandle<std::uint32_t> instance_ids;
    BufferHandle<gpu::DrawCommand> draws;  ///< those of the layout
    BufferHandle<gpu::Material> materials;
    BufferHandle<std::uint32_t> texels;     ///< reduced images of the materials, for tracing
    BufferHandle<gpu::Instance> instances;  ///< by drawable: world matrix and material
    /// By vertex, of those that have them; none where no surface needs them.
    std::optional<BufferHandle<glm::vec2>> second_uvs{};
    /// Passes that draw need no programs for other surfaces.
    SurfaceKinds kinds{.opaque = true, .masked = true, .blended = true};
};

/// Adds nodes `scene-gather` (CPU: SceneList, from MeshInstance, Transform and DeformedMesh), `scene-upload`
/// (CPU, then upload: KeptLayout, when items come or go, or deformed vertices change) and `instance-upload`
/// (CPU, then upload: the world matrices of what has come or moved). With
/// `second_uvs` also `second-uv-upload` (CPU, then upload: all of them, when the set of items changes).
[[nodiscard]] SceneData add_scene_upload(FrameGraph& graph, Gpu& gpu, bool second_uvs = false);

}  // namespace candela
