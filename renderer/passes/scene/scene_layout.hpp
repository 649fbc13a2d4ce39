#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include <candela/scene/components.hpp>
#include "engine/bvh/box.hpp"
#include "engine/shared_array.hpp"
#include "renderer/gpu/gpu_types.hpp"
#include "renderer/passes/scene/material_binding.hpp"
#include "renderer/passes/scene/scene_list.hpp"

namespace candela {

/// A part of a primitive: so many triangles that follow each other, the last part fewer.
inline constexpr std::uint32_t triangles_per_part = 256;

/// A primitive of a mesh, with what is the same wherever it is drawn.
struct DrawnPrimitive {
    std::shared_ptr<const Mesh> mesh{};
    std::uint32_t mesh_number = 0;     ///< in the MeshTable
    std::uint32_t index_in_mesh = 0;   ///< of the primitive
    std::uint32_t first_triangle = 0;  ///< index in the mesh of the primitive's first triangle
    std::uint32_t material = 0;        ///< index into SceneLayout::materials
    Box bounds{};                      ///< bounding box, local space: see bounds_of
    float albedo = 0.0F;               ///< strongest channel of its mean albedo
    bool is_solid = true;              ///< opaque or masked: it stops light
    std::vector<Box>
        parts{};  ///< the boxes around its parts, local space: see parts_of. None for a single one.

    [[nodiscard]] const Primitive& primitive() const { return mesh->primitives[index_in_mesh]; }
};

/// Sorts the primitives of a scene's entities in a way that does not depend on what has come and gone before.
using PrimitiveKey = std::uint64_t;
[[nodiscard]] inline PrimitiveKey key_of(Entity entity, const DrawnPrimitive& drawn) {
    return PrimitiveKey{entity.index} << 32U | drawn.index_in_mesh;
}

/// What the GPU buffers of the scene contain.
struct SceneLayout {
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

    /// One primitive of one item. It has one draw command and one record in the instance buffer. Its number
    /// stays the same as long as its entity keeps the mesh, whatever comes and goes.
    struct Drawable {
        Entity entity{};
        std::uint32_t item = none;
        std::uint32_t next = none;                    ///< the next drawable of the item
        std::shared_ptr<const DrawnPrimitive> drawn;  ///< null where the number is not in use
        bool operator==(const Drawable&) const = default;

        [[nodiscard]] const Primitive& primitive() const { return drawn->primitive(); }
    };
    /// Draw commands that follow each other, of materials with the same binding. Some may be of no drawable:
    /// those draw no instance.
    struct Group {
        std::uint32_t first_draw;
        std::uint32_t draw_count;
        std::shared_ptr<const MaterialBinding> material;
        bool mirrored;
    };
    SceneGeometry geometry;
    SharedArray<Drawable> drawables;           ///< by number
    SharedArray<std::uint32_t> first_of_item;  ///< by item: its first drawable, or `none`
    /// In drawing order, in each group by the entities' indices. The base instance is the drawable's number.
    SharedArray<gpu::DrawCommand> draws;
    SharedArray<std::uint32_t> draw_of;                      ///< by drawable: the index of its draw command
    std::vector<Group> groups;                               ///< opaque, then masked, then blended
    SharedArray<std::shared_ptr<const Material>> materials;  ///< null where an index is not in use

    /// The groups of one alpha mode.
    [[nodiscard]] std::span<const Group> groups_of(AlphaMode alpha) const;
    /// Calls `visit(number)` for the drawables of an item, in the order of its primitives.
    template <class Visit>
    void visit_drawables(std::size_t item, Visit visit) const {
        for (std::uint32_t i = first_of_item[item]; i != none; i = drawables[i].next) visit(i);
    }
    /// Calls `visit(number)` for all drawables that stop light, opaque and masked ones, in the order of the
    /// items. It does not depend on what has come and gone before.
    template <class Visit>
    void visit_solids(Visit visit) const {
        for (std::size_t item = 0; item < first_of_item.size(); ++item) {
            visit_drawables(item, [&](std::uint32_t i) {
                if (is_solid(drawables[i])) visit(i);
            });
        }
    }
    /// Calls `visit(group, draw)` for the draw commands of all blended drawables.
    template <class Visit>
    void visit_blended(Visit visit) const {
        for (const Group& group : groups_of(AlphaMode::blend)) {
            for (std::uint32_t i = group.first_draw; i < group.first_draw + group.draw_count; ++i) {
                if (draws[i].instance_count > 0) visit(group, i);
            }
        }
    }
    /// Whether a number is in use, for something that stops light.
    [[nodiscard]] static bool is_solid(const Drawable& drawable) {
        return drawable.drawn && drawable.drawn->is_solid;
    }
};

/// The vertices of a drawable: those of its mesh, or the deformed ones.
[[nodiscard]] std::span<const Vertex> vertices_of(const SceneLayout::Drawable& drawable,
                                                  const Deformations& deformed);
/// The box around them; local space.
[[nodiscard]] const Box& bounds_of(const SceneLayout::Drawable& drawable, const Deformations& deformed);
/// The boxes around its parts; a single one around all that is deformed. Local space.
[[nodiscard]] std::span<const Box> parts_of(const SceneLayout::Drawable& drawable,
                                            const Deformations& deformed);

/// The numbers of the drawables whose items are elsewhere than before, ascending. `now` has as many items as
/// the layout; what only one of both has is left out.
[[nodiscard]] std::vector<std::uint32_t> moved_drawables(const SceneLayout& layout,
                                                         const SharedArray<glm::mat4>& before,
                                                         const SharedArray<glm::mat4>& now);

/// The numbers of the solid drawables that are elsewhere than before or deformed in another way, ascending.
[[nodiscard]] std::vector<std::uint32_t> moved_solids(const SceneLayout& layout, const ScenePlacement& before,
                                                      const ScenePlacement& now);

}  // namespace candela
