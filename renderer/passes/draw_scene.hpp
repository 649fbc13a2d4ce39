#pragma once

#include "engine/graph/execute.hpp"
#include "renderer/gpu.hpp"
#include "renderer/passes/scene_upload.hpp"

namespace candela {

// For the passes that rasterise the scene.

/// Declares what drawing the meshes reads.
void read_meshes(Pass& pass, const SceneData& scene);

/// Declares what shading their surfaces reads besides.
void read_materials(Pass& pass, const SceneData& scene);

/// Binds vertices, indices, instances and draw arguments; then `draw_depth` as often as wanted.
void bind_meshes(Gpu& gpu, Execution& run, const SceneData& scene);

/// Draws everything at once with the bound program, from both sides, without materials.
void draw_depth(const Gpu& gpu, Execution& run, const SceneData& scene);

/// Clears the bound targets, colour to 0 and reversed depth to "nothing", and turns the depth test on.
void begin_surfaces(const Gpu& gpu);

/// Draws everything with its materials; the backs of single-sided ones are culled. Binds what it needs.
void draw_surfaces(Gpu& gpu, Execution& run, const SceneData& scene, const gl::Program& program);

}  // namespace candela
