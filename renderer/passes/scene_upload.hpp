#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "engine/bvh/box.hpp"
#include "engine/graph/frame_graph.hpp"
#include "engine/scene/components.hpp"
#include "renderer/gpu.hpp"
#include "renderer/gpu_types.hpp"

namespace candela {

/// What is placed in the world, in the order of the world's view.
struct SceneGeometry {
    struct Item {
        std::shared_ptr<const Mesh> mesh;
        bool mirrored = false;  ///< the placement turns its triangles inside out
        bool operator==(const Item&) const = default;
    };
    std::vector<Item> items;
    bool operator==(const SceneGeometry&) const = default;
};

/// Where each item of the geometry is: local to world, metres.
struct ScenePlacement {
    std::vector<glm::mat4> world;
    bool operator==(const ScenePlacement&) const = default;
};

/// A base-colour image on the GPU, with its mip maps and wrap modes.
struct MaterialTexture {
    gl::Texture texture;
    gl::Sampler sampler;
};

/// How the geometry lies in the buffers.
struct SceneLayout {
    /// One primitive of one item: one draw, one record of the instance buffer.
    struct Drawable {
        std::uint32_t item;
        const Primitive* primitive;  ///< kept alive by `geometry`
        std::uint32_t material;      ///< index into `materials`
        Box bounds;                  ///< of the primitive, local space
    };
    /// Consecutive draws that differ in nothing but their geometry. Blended draws have a group each, so that
    /// they can be sorted.
    struct Group {
        std::uint32_t first_draw;
        std::uint32_t draw_count;
        AlphaMode alpha;
        std::shared_ptr<const MaterialTexture> texture;  ///< null: none
        bool double_sided;
        bool mirrored;
        glm::vec3 centre{0.0F};  ///< of the bounds of a blended draw, local space
    };
    SceneGeometry geometry;
    std::vector<Drawable> drawables;      ///< the opaque ones first, then the masked, then the blended ones
    std::vector<gpu::DrawCommand> draws;  ///< of the drawables
    std::vector<Group> groups;            ///< in the order of the drawables
    std::vector<std::shared_ptr<const Material>> materials;
    std::uint32_t opaque_count = 0;  ///< of drawables
    std::uint32_t solid_count = 0;   ///< of drawables, opaque and masked: those that stop light

    /// The groups of one alpha mode.
    [[nodiscard]] std::span<const Group> groups_of(AlphaMode alpha) const;
    /// The drawables that stop light.
    [[nodiscard]] std::span<const Drawable> solids() const { return std::span(drawables).first(solid_count); }
};

/// The scene on the GPU.
struct SceneData {
    ValueHandle<ScenePlacement> placement;
    ValueHandle<SceneLayout> layout;
    BufferHandle<Vertex> vertices;
    BufferHandle<std::uint32_t> indices;
    BufferHandle<std::uint32_t>
        instance_ids;  ///< 0, 1, 2, ...: fetched per instance, from the draw's base instance on
    BufferHandle<gpu::DrawCommand> draws;
    BufferHandle<gpu::Material> materials;
    BufferHandle<std::uint32_t> texels;  ///< reduced base-colour images, for tracing
    BufferHandle<gpu::Instance> instances;
};

/// Nodes `scene-gather` (CPU: what is where), `scene-upload` (meshes and materials, when what is there
/// changes) and `instance-upload` (matrices, when something moves).
[[nodiscard]] SceneData add_scene_upload(FrameGraph& graph, Gpu& gpu);

}  // namespace candela
