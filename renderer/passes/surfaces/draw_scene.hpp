#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <candela/graph/execute.hpp>
#include "renderer/gpu/gpu.hpp"
#include "renderer/passes/scene/scene_upload.hpp"

namespace candela {

// Helpers for passes that rasterise the scene.

/// Declares the reads of a pass that draws surfaces with mesh_surface.vert or shadow_maps.vert. Returns them.
std::vector<ResourceHandle> read_meshes(Pass& pass, const SceneData& scene);

/// Sets up the vertex array for the meshes: vertices, instance numbers and indices.
void bind_meshes(Gpu& gpu, Execution& run, const SceneData& scene);

/// Draws `count` commands of the bound indirect buffer, from number `first` on, with the bound program.
/// Requires bind_meshes; needs no materials.
void draw_commands(Gpu& gpu, std::size_t first, std::size_t count, const gl::RasterState& state);

/// The same for commands of a group. Binds its images; its winding replaces that of `state`.
void draw_in_group(Gpu& gpu, const SceneLayout::Group& group, std::size_t first, std::size_t count,
                   gl::RasterState state);

/// The nearest surfaces, with their depth.
inline constexpr gl::RasterState nearest_surfaces{.depth_test = gl::DepthTest::nearer};
/// The visible surfaces, where their depth is in the target already.
inline constexpr gl::RasterState visible_surfaces{.depth_test = gl::DepthTest::equal, .writes_depth = false};
/// The same surfaces again, to add to their colour.
inline constexpr gl::RasterState visible_surfaces_again{
    .depth_test = gl::DepthTest::equal, .writes_depth = false, .blending = gl::Blending::add};

/// A program for opaque surfaces, and its variant for masked surfaces, which discards fragments in holes;
/// null if the scene has none. Owned by the Gpu.
struct SurfacePrograms {
    const gl::Program* opaque;
    const gl::Program* masked;
};

/// The names in `words`, and those that programs with mesh_surface.vert need for the vertices of the scene.
[[nodiscard]] std::vector<std::string> mesh_variant(const SceneData& scene, std::vector<std::string> words);

/// Both variants of a program from mesh_surface.vert and `fragment_stage`, with the names of mesh_variant
/// defined.
[[nodiscard]] SurfacePrograms surface_programs(Gpu& gpu, const SceneData& scene,
                                               const std::string& fragment_stage,
                                               std::vector<std::string> defined = {});

/// Draws the opaque and masked surfaces, of groups for which `is_drawn` holds. Culls the back faces of
/// single-sided surfaces. Binds meshes and images.
void draw_surfaces(
    Gpu& gpu, Execution& run, const SceneData& scene, const SurfacePrograms& programs, gl::RasterState state,
    const gl::Uniforms& uniforms = {},
    bool (*is_drawn)(const SceneLayout::Group&) = [](const SceneLayout::Group&) { return true; });

}  // namespace candela
