#pragma once

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

/// Draws all opaque surfaces in one call with the bound program. Requires bind_meshes; needs no materials.
void draw_depth(const Gpu& gpu, Execution& run, const SceneData& scene);

/// Draws the masked surfaces with the bound program. Requires bind_meshes; binds the images.
void draw_masked_depth(const Gpu& gpu, Execution& run, const SceneData& scene);

/// Draws one group with the bound program. Binds its images and sets the winding of its front faces.
void draw_group(const Gpu& gpu, const SceneLayout::Group& group);

/// Clears the bound targets, colour to 0 and depth to 0 (reversed: infinitely far), and turns the depth test
/// on.
void begin_surfaces(const Gpu& gpu);

/// For targets whose depth a pre-pass has filled: clears colour, and tests for equal depth without writing
/// it, so that only visible surfaces are shaded.
void begin_visible_surfaces(const Gpu& gpu);

/// For drawing the same surfaces again: adds to the colour of the visible ones. Alpha is replaced, not added.
void begin_adding(const Gpu& gpu);

/// A program for opaque surfaces, and its variant for masked surfaces, which discards fragments in holes.
/// Owned by the Gpu.
struct SurfacePrograms {
    const gl::Program* opaque;
    const gl::Program* masked;

    /// Calls `set(const gl::Program&)` for both, to bind and set what they read.
    template <class Set>
    void each(Set set) const {
        set(*opaque);
        set(*masked);
    }
};

/// Both variants of a program from mesh_surface.vert and `fragment_stage`, with the names in `defined`
/// defined.
[[nodiscard]] SurfacePrograms surface_programs(Gpu& gpu, const std::string& fragment_stage,
                                               std::vector<std::string> defined = {});

/// Draws the opaque and masked surfaces, grouped by image: those of groups for which `is_drawn` holds. Culls
/// the back faces of single-sided surfaces. Binds meshes and images.
void draw_surfaces(
    Gpu& gpu, Execution& run, const SceneData& scene, const SurfacePrograms& programs,
    bool (*is_drawn)(const SceneLayout::Group&) = [](const SceneLayout::Group&) { return true; });

}  // namespace candela
