#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <candela/graph/frame_graph.hpp>
#include <candela/scene/components.hpp>
#include "engine/bvh/box.hpp"
#include "renderer/gpu/gpu.hpp"
#include "renderer/gpu/gpu_types.hpp"
#include "renderer/passes/scene/material_binding.hpp"
#include "renderer/passes/scene/scene_list.hpp"

namespace candela {

/// A part of a primitive: so many triangles that follow each other, the last part fewer.
inline constexpr std::uint32_t triangles_per_part = 256;

/// What the GPU buffers of the scene contain.
struct SceneLayout {
    /// One primitive of one item. It has one draw command and one record in the instance buffer.
    struct Drawable {
        std::uint32_t item;
        const Primitive* primitive;       ///< kept alive by `geometry`
        std::uint32_t material;           ///< index into `materials`
        Box bounds;                       ///< bounding box of the primitive, local space: see bounds_of
        float albedo = 0.0F;              ///< strongest channel of its mean albedo
        std::uint32_t index_in_mesh = 0;  ///< of the primitive
        /// The boxes around its parts, local space: see parts_of. Null if there is only one.
        std::shared_ptr<const std::vector<Box>> parts{};
    };
    /// Consecutive draws of materials with the same binding. Each blended draw has its own group, so that
    /// they can be sorted.
    struct Group {
        std::uint32_t first_draw;
        std::uint32_t draw_count;
        MaterialBinding material;
        bool mirrored;
    };
    SceneGeometry geometry;
    std::vector<Drawable> drawables;      ///< in drawing order: opaque, then masked, then blended
    std::vector<gpu::DrawCommand> draws;  ///< by drawable
    std::vector<Group> groups;            ///< in drawing order
    std::vector<std::shared_ptr<const Material>> materials;  ///< null where an index is not in use
    std::uint32_t solid_count = 0;  ///< number of opaque and masked drawables: they stop light
    /// Numbers of drawables, item by item, ascending: those of item i are from first_of_item[i] up to
    /// first_of_item[i + 1].
    std::vector<std::uint32_t> by_item;
    std::vector<std::uint32_t> first_of_item;

    /// The groups of one alpha mode.
    [[nodiscard]] std::span<const Group> groups_of(AlphaMode alpha) const;
    /// The numbers of an item's drawables.
    [[nodiscard]] std::span<const std::uint32_t> drawables_of(std::size_t item) const {
        return std::span(by_item).subspan(first_of_item[item], first_of_item[item + 1] - first_of_item[item]);
    }
    /// The drawables that stop light.
    [[nodiscard]] std::span<const Drawable> solids() const { return std::span(drawables).first(solid_count); }
};

/// The vertices of a drawable: those of its mesh, or the deformed ones.
[[nodiscard]] std::span<const Vertex> vertices_of(const SceneLayout::Drawable& drawable,
                                                  const Deformations& deformed);
/// The box around them; local space.
[[nodiscard]] const Box& bounds_of(const SceneLayout::Drawable& drawable, const Deformations& deformed);
/// The boxes around its parts; a single one around all that is deformed. Local space.
[[nodiscard]] std::span<const Box> parts_of(const SceneLayout::Drawable& drawable,
                                            const Deformations& deformed);

/// The numbers of the drawables whose items are elsewhere than before, ascending. Both have as many items as
/// the layout.
[[nodiscard]] std::vector<std::uint32_t> moved_drawables(const SceneLayout& layout,
                                                         const SharedArray<glm::mat4>& before,
                                                         const SharedArray<glm::mat4>& now);

/// The numbers of the solid drawables that are elsewhere than before or deformed in another way, ascending.
[[nodiscard]] std::vector<std::uint32_t> moved_solids(const SceneLayout& layout, const ScenePlacement& before,
                                                      const ScenePlacement& now);

/// The scene on the GPU, with its description on the CPU.
struct SceneData {
    ValueHandle<ScenePlacement> placement;
    ValueHandle<SceneLayout> layout;
    BufferHandle<Vertex> vertices;
    BufferHandle<std::uint32_t> indices;  ///< relative to the draw's base vertex
    /// 0, 1, 2, ...: a per-instance vertex attribute, which gives shaders the draw's base instance.
    BufferHandle<std::uint32_t> instance_ids;
    BufferHandle<gpu::DrawCommand> draws;  ///< by drawable
    BufferHandle<gpu::Material> materials;
    BufferHandle<std::uint32_t> texels;     ///< reduced images of the materials, for tracing
    BufferHandle<gpu::Instance> instances;  ///< by drawable: world matrix and material
    /// By vertex, of those that have them; none where no surface needs them.
    std::optional<BufferHandle<glm::vec2>> second_uvs{};
    /// Passes that draw need no programs for other surfaces.
    SurfaceKinds kinds{.opaque = true, .masked = true, .blended = true};
};

/// Adds nodes `scene-gather` (CPU: SceneList, from MeshInstance, Transform and DeformedMesh), `scene-upload`
/// (CPU, then upload: meshes and materials, when the set of items changes, only those that the scene had not
/// before; and deformed vertices, when they change) and `instance-upload` (CPU, then upload: the world
/// matrices of what has moved). With
/// `second_uvs` also `second-uv-upload` (CPU, then upload: all of them, when the set of items changes).
[[nodiscard]] SceneData add_scene_upload(FrameGraph& graph, Gpu& gpu, bool second_uvs = false);

}  // namespace candela
