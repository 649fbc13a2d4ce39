#pragma once

#include <string>
#include <vector>

#include "engine/graph/execute.hpp"
#include "renderer/gpu.hpp"
#include "renderer/passes/scene_upload.hpp"

namespace candela {

// For the passes that rasterise the scene.

/// Declares what drawing the meshes reads.
void read_meshes(Pass& pass, const SceneData& scene);

/// Declares what their surfaces, shaded or masked, read besides.
void read_materials(Pass& pass, const SceneData& scene);

/// Whether any of it has changed since the running pass drew last.
[[nodiscard]] bool meshes_changed(const Execution& run, const SceneData& scene);
[[nodiscard]] bool materials_changed(const Execution& run, const SceneData& scene);

/// Binds vertices, indices, instances and draw arguments.
void bind_meshes(Gpu& gpu, Execution& run, const SceneData& scene);
void bind_materials(const Gpu& gpu, Execution& run, const SceneData& scene);

/// Draws all opaque surfaces at once with the bound program, which needs the meshes and no materials.
void draw_depth(const Gpu& gpu, Execution& run, const SceneData& scene);

/// Draws the masked surfaces with the bound program, which needs meshes and materials; binds their images.
void draw_masked_depth(const Gpu& gpu, Execution& run, const SceneData& scene);

/// Draws one group with the bound program; binds its image and sets which side is the front.
void draw_group(const Gpu& gpu, const SceneLayout::Group& group);

/// Clears the bound targets, colour to 0 and reversed depth to "nothing", and turns the depth test on.
void begin_surfaces(const Gpu& gpu);

/// For targets whose depth a pre-pass has filled: clears colour, and lets only those surfaces through that
/// are seen.
void begin_visible_surfaces(const Gpu& gpu);

/// For surfaces that are drawn once more: adds to the colour of those that are seen.
void begin_adding(const Gpu& gpu);

/// A program for opaque surfaces, and the same for masked ones, which drops fragments in holes. Owned by the
/// Gpu.
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

/// Programs of this fragment stage over meshes, with these words defined.
[[nodiscard]] SurfacePrograms surface_programs(Gpu& gpu, const std::string& fragment_stage,
                                               std::vector<std::string> defined = {});

/// Draws all opaque and masked surfaces with their materials; the backs of single-sided ones are culled.
/// Binds what it needs.
void draw_surfaces(Gpu& gpu, Execution& run, const SceneData& scene, const SurfacePrograms& programs);

}  // namespace candela
